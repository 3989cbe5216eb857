#include "gateway/rmac/simulator/collision_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "gateway/api/decode.hpp"
#include "gateway/material/stock_model.hpp"
#include "gateway/rmac/simulator/mounted_tool.hpp"
#include "gateway/rmac/simulator/shaped_machine.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kWattsPerHorsePower = 745.69987;
/// After a cut axes come up to their setpoints, and a tool springs back with its force, a mean over a turn.
constexpr double kSettling_s = 0.05, kSettlingTurns = 6, kLongestSettling_s = 0.5;
constexpr double kSettling_mm = 0.05;

/// Nothing beside where it ended, or deeper, is what springs back.
bool stays_or_leaves(const ToolPose& ended_at, const Vector& tip) {
  double out = 0, way2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double way = tip[i] - ended_at.tip[i];
    out += way * ended_at.axis[i], way2 += way * way;
  }
  return out > -kSettling_mm && way2 - out * out < kSettling_mm * kSettling_mm;
}

}  // namespace

Result<std::unique_ptr<CollisionWatch>> CollisionWatch::open(const std::string& machine, const fs::path& device_tree,
                                                             gateway::Setup setup, const Options& options) {
  auto shaped = read_shaped_machine(machine, device_tree, "collisions cannot be checked");
  if (!shaped) return tl::unexpected(shaped.error());
  if (shaped->name != setup.machine) {
    return fail(fmt::format("{}: /Machine is \"{}\", and the program is simulated on {}", options.setup_file.string(),
                            setup.machine, shaped->name));
  }
  auto bodies = gateway::scene_bodies(shaped->bodies, setup);
  if (!bodies) return fail(fmt::format("{}: {}", options.setup_file.string(), bodies.error().message));
  std::unique_ptr<CollisionWatch> watch(
      new CollisionWatch(options.setup_file, setup,
                         std::make_unique<gateway::CollisionChecker>(shaped->chain, std::move(*bodies),
                                                                     setup.part_frame, setup.clearance_mm)));
  if (setup.stock) {
    auto grid = gateway::Stock::read(*setup.stock).and_then([&](const gateway::Stock& stock) {
      return gateway::model_of(stock, options.resolution_mm ? options.resolution_mm : setup.resolution_mm);
    });
    if (!grid) return fail(fmt::format("{}: {}", options.setup_file.string(), grid.error().message));
    gateway::CollisionChecker& checker = *watch->checker_;
    watch->material_ = std::make_unique<gateway::Material>(std::move(shaped->chain), std::move(*grid), setup.part_frame,
                                                           checker.findings());
    checker.stock_is_followed();
    if (auto fine = watch->watch_load(options.materials); !fine) return tl::unexpected(fine.error());
  }
  return watch;
}

Result<> CollisionWatch::place_part(gateway::Simulation& simulation) const {
  const auto stands =
      simulation.call("RMAC_CAM.SetPartFrame", {{"PartFrame", gateway::frame_to_json(setup_.part_frame)}});
  if (!stands) return fail(fmt::format("{}: /PartFrame: {}", file_.string(), stands.error().message));
  return {};
}

Result<> CollisionWatch::watch_load(const fs::path& materials) {
  if (setup_.material.empty()) return {};
  const auto known = gateway::WorkMaterials::read(materials);
  if (!known) return fail(known.error().message);
  const auto material = known->find(setup_.material);
  if (!material) {
    unknown_material_ = "no forces are told: " + material.error().message;
    return {};
  }
  load_ =
      std::make_unique<gateway::CuttingLoad>(**material, *std::ranges::max_element(material_->grid().layout().pitch));
  material_->listen(*load_);
  return {};
}

std::vector<std::string> CollisionWatch::forces_not_told() const {
  if (load_) return {load_->not_told().begin(), load_->not_told().end()};
  if (!unknown_material_.empty()) return {unknown_material_};
  return {};
}

bool CollisionWatch::may_cut(const Move& move) noexcept {
  return !std::holds_alternative<PathTargetGeometry>(move.geometry) &&
         !std::holds_alternative<JointTargetGeometry>(move.geometry);
}

bool CollisionWatch::leads_somewhere(const Move& move) noexcept {
  const auto* const joints = std::get_if<JointTargetGeometry>(&move.geometry);
  return joints == nullptr || !joints->joints.empty();
}

void CollisionWatch::move_done() {
  if (queue_.empty()) return;
  begun_ = begun_ || queue_.front().leads;
  queue_.pop_front();
}

void CollisionWatch::take_tool(gateway::Controller& controller) {
  const gateway::Tool tool = mounted_tool(controller);
  tool_fault_.clear();
  if (tool.number == gateway::kNoTool) {
    tool_fault_ = "no tool is in the spindle by the tool table: moves without one were checked with the spindle alone";
  } else if (!tool.shape) {
    tool_fault_ = fmt::format(
        "tool {} has no Shape in the tool table: moves with it were checked with the spindle alone, and cut nothing",
        tool.number);
  }
  checker_->set_tool(tool);
  too_thin_ = material_ ? material_->set_tool(tool) : "";
  if (load_) load_->set_tool(tool);
}

gateway::MoveNow CollisionWatch::planned_move(const gateway::CycleSample& sample, int line) const {
  const bool cutting = sample.moving && !queue_.empty() && queue_.front().cuts;
  return {.id = sample.move_id, .line = line, .cutting = cutting};
}

gateway::MoveNow CollisionWatch::cut_under_way(const gateway::CycleSample& sample, const gateway::MoveNow& planned) {
  if (!by_axes_) return planned;
  if (planned.cutting) {
    last_cut_ = {planned, sample.t_s, sample.pose_set};
    // In the cycle in which the next one begins it is not done yet.
    last_cut_.move.id = queue_.front().id;
    return last_cut_.move;
  }
  if (last_cut_.ended_s < 0 || !stays_or_leaves(last_cut_.ended_at, sample.pose_set.tip)) return planned;
  const double rpm = std::abs(sample.spindle_rpm.front());
  const double settling_s = kSettling_s + (rpm > 0 ? std::min(kSettlingTurns * 60 / rpm, kLongestSettling_s) : 0);
  // Who dwells where a cut ended is on no way: what axes cut there that stick and slip about it is the cut's still.
  return !sample.moving || sample.t_s - last_cut_.ended_s < settling_s ? last_cut_.move : planned;
}

void CollisionWatch::cycle(const gateway::CycleSample& sample, int line, gateway::Controller& controller,
                           const Eigen::Vector3d& bend_mm) {
  const sdk::DeviceObject* const device = controller.mechanism();
  if (device == nullptr || device->name != setup_.machine) {
    if (device != nullptr && sample.moving) {
      not_checked_.insert(fmt::format("moves of {}: the set-up is for {}", device->name, setup_.machine));
    }
    return;
  }
  if (std::exchange(look_at_tool_, false)) take_tool(controller);
  if (sample.moving && !tool_fault_.empty()) not_checked_.insert(tool_fault_);
  if (sample.moving && !too_thin_.empty()) not_checked_.insert(too_thin_);
  const gateway::MoveNow move = planned_move(sample, line);
  // A simulation begins with all joints at 0, where the machine need not stand: the way from there to the first
  // position is nobody's.
  if (!begun_ && !move.cutting) return;
  begun_ = true;
  const std::span joints = std::span(sample.position_set).first(sample.joint_count);
  checker_->advance(sample.t_s, joints, move);
  if (!material_) return;
  // A machine that has no spindle for the controller turns its tool some other way.
  const bool turns =
      device->spindles.empty() || std::ranges::any_of(sample.spindle_rpm, [](double rpm) { return rpm != 0; });
  if (load_ && !device->spindles.empty()) {
    const sdk::Spindle& spindle = device->spindles.front();
    load_->set_spindle(sample.spindle_rpm.front(),
                       {.torque_nm = spindle.max_torque_nm, .power_w = spindle.horse_power * kWattsPerHorsePower});
  }
  material_->advance(sample.t_s, joints, turns ? cut_under_way(sample, move) : move, turns, bend_mm);
}

void CollisionWatch::finish() {
  if (!material_) return;
  material_->finish();
  if (material_->grid().overflowed()) {
    not_checked_.insert(
        "the material fell into too many pieces, and not all that was cut is gone; choose a coarser "
        "--resolution");
  }
}

nlohmann::json to_json(const std::vector<gateway::Finding>& findings, bool near) {
  nlohmann::json list = nlohmann::json::array();
  for (const gateway::Finding& f : findings) {
    if (f.collision == near) continue;
    nlohmann::json entry{
        {"line", f.line},       {"move_id", f.move_id},          {"t_s", f.t_s},
        {"until_s", f.until_s}, {"bodies", {f.first, f.second}}, {"place_mm", {f.place[0], f.place[1], f.place[2]}}};
    if (near) {
      entry["distance_mm"] = f.distance_mm;
    } else {
      entry["depth_mm"] = f.depth_mm;
      entry["certain"] = !f.possible;
      if (!f.why.empty()) entry["why"] = f.why;
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace rmac::cli
