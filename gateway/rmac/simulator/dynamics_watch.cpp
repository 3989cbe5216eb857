#include "gateway/rmac/simulator/dynamics_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "gateway/device_database/device_database.hpp"
#include "gateway/device_database/device_json.hpp"
#include "gateway/device_driver_manager/device_tree.hpp"
#include "gateway/forces/turn_forces.hpp"
#include "gateway/rmac/simulator/machine_modules.hpp"
#include "gateway/rmac/simulator/mounted_tool.hpp"
#include "gateway/rmac/simulator/watch_verdict.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {
namespace {

constexpr double kMostBend = 0.05;  ///< of the cutting diameter
constexpr int kPositions = 72;      ///< of the tool, from tooth to tooth

}  // namespace

DynamicsWatch::DynamicsWatch(const sdk::DeviceObject& device, std::unique_ptr<gateway::AxisDynamics> axes,
                             CollisionWatch* cuts)
    : machine_(device.name), configured_(gateway::to_device_json(device)), axes_(std::move(axes)), cuts_(cuts) {
  if (cuts == nullptr) return;
  cuts->goes_by_axes(*this);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(i);
    const Vector there = rotate(cuts->setup().part_frame.q, {unit[0], unit[1], unit[2]});
    to_link_.col(i) = Eigen::Vector3d(there[0], there[1], there[2]);
  }
}

Result<std::unique_ptr<DynamicsWatch>> DynamicsWatch::open(const std::string& machine,
                                                           const std::filesystem::path& device_tree, double period_s,
                                                           CollisionWatch* cuts) {
  const auto device_json = gateway::find_device_json(machine, device_tree);
  if (!device_json) return fail(device_json.error().message);
  const auto device = gateway::read_device_database(*device_json);
  if (!device) return fail(device.error().message);
  auto axes = gateway::AxisDynamics::open(*device, loader_of(*device, *device_json, device_tree), period_s);
  if (!axes) return fail(fmt::format("{}: {}", device_json->string(), axes.error().message));
  return std::unique_ptr<DynamicsWatch>(new DynamicsWatch(*device, std::move(*axes), cuts));
}

void DynamicsWatch::take_tool(const gateway::Tool& tool) {
  tool_ = {.number = tool.number,
           .tip = gateway::tip_on_interface(tool),
           .bending = {},
           .no_bending = {},
           .most_bend_mm = kMostBend * (tool.shape ? tool.shape->dc : 0),
           .most_rpm = tool.max_rpm};
  if (auto bending = gateway::bending_of(tool)) {
    tool_.bending = std::move(*bending);
  } else {
    tool_.no_bending =
        fmt::format("how far tool {} bends, and whether it chatters: {}", tool.number, bending.error().message);
  }
  axes_->forget_path();
}

double DynamicsWatch::most_rpm() const noexcept {
  if (tool_.most_rpm <= 0 || spindle_most_rpm_ <= 0) return std::max(tool_.most_rpm, spindle_most_rpm_);
  return std::min(tool_.most_rpm, spindle_most_rpm_);
}

void DynamicsWatch::take_force(const gateway::CycleSample& planned, int line) {
  const double passed_s = planned.t_s - std::exchange(told_s_, planned.t_s);
  if (cuts_ == nullptr || cuts_->load() == nullptr) return;
  const double turns_s = std::abs(planned.spindle_rpm.front()) / 60;
  const gateway::CuttingNow now = cuts_->load()->now(planned.t_s);
  // A spindle that stands has no turn to take a mean over: what pushed is gone at once.
  force_n_ += (turns_s > 0 ? std::min(1.0, turns_s * passed_s) : 1.0) * (now.force_n - force_n_);
  bend_mm_ = tool_.bending.compliance_mm_n * (force_n_ - force_n_.dot(now.axis) * now.axis);
  if (bend_mm_.norm() <= tool_.most_bend_mm) return;
  bend_mm_ *= tool_.most_bend_mm / bend_mm_.norm();
  if (broken_.insert(tool_.number).second) {
    not_told_.insert(fmt::format(
        "tool {} would bend by more than {:.3g} mm, a twentieth of its diameter, first in line {}: it is too "
        "slender for this cut, or softer than it is made; what it cuts and takes there is not told",
        tool_.number, tool_.most_bend_mm, line));
  }
}

void DynamicsWatch::engaged(const gateway::EngagedTool& tool) {
  if (!tool.move.cutting) return;  // what a positioning move meets is a collision
  if (!tool_.no_bending.empty()) not_told_.insert(tool_.no_bending);
  const Eigen::Vector3d& axis = tool.at.axis;
  const Eigen::Vector3d x = tool.goes.isZero() ? axis.unitOrthogonal() : tool.goes;
  const auto stiffness =
      gateway::chip_stiffness(tool.mill, cuts_->load()->material().coefficients, tool.slices, tool.feed, kPositions);
  if (!stiffness) return;  // then nor could forces be told
  Eigen::Matrix3d feed_frame;
  feed_frame << x, axis.cross(x), axis;
  std::vector<gateway::VibrationMode> modes = axes_->modes(tool_.tip);
  for (gateway::VibrationMode& mode : modes) mode.directions = to_link_.transpose() * mode.directions * to_link_;
  const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
  for (const gateway::TipMode& mode : tool_.bending.modes) {
    modes.push_back({.frequency_hz = mode.frequency_hz,
                     .damping_ratio = mode.damping_ratio,
                     .stiffness_n_mm = mode.stiffness_n_mm,
                     .directions = across});
  }
  std::vector<Eigen::Matrix3d> over_pitch;
  over_pitch.reserve(stiffness->over_pitch.size());
  for (const Eigen::Matrix3d& each : stiffness->over_pitch) {
    over_pitch.emplace_back(feed_frame * each * feed_frame.transpose());
  }
  chatter_.add({.cutting_n_mm = feed_frame * stiffness->mean * feed_frame.transpose(),
                .over_pitch_n_mm = std::move(over_pitch),
                .teeth = tool.mill.teeth(),
                .rpm = tool.rpm,
                .most_rpm = most_rpm(),
                .t_s = tool.t_s,
                .line = tool.move.line,
                .move_id = tool.move.id,
                .place = tool.at.tip},
               modes);
}

void DynamicsWatch::check_configuration(const sdk::DeviceObject& device) {
  if (gateway::to_device_json(device) == configured_) return;
  not_told_.insert("the program configures the machine anew: what its axes do is told by device.json all the same");
}

void DynamicsWatch::finish() {
  axes_->finish();
  if (cuts_ != nullptr && !cuts_->forces_not_told().empty()) {
    not_told_.insert(
        "not all that pushes the tool is known: what is missing of the cutting forces is missing here too");
  }
}

TrueCycle DynamicsWatch::cycle(const gateway::CycleSample& planned, int line, gateway::Controller& controller) {
  const sdk::DeviceObject* const device = controller.mechanism();
  if (device == nullptr || device->name != machine_) {
    if (device != nullptr && planned.moving) {
      not_told_.insert(fmt::format("moves of {}: the axes are those of {}", device->name, machine_));
    }
    return {planned};
  }
  if (std::exchange(look_at_configuration_, false)) check_configuration(*device);
  if (std::exchange(look_at_tool_, false)) {
    take_tool(mounted_tool(controller));
  }
  spindle_most_rpm_ = controller.cam().spindles().max_rpm(0).value_or(0);
  // Where the machine stands before nobody knows.
  begun_ = begun_ || planned.moving;
  if (!begun_) return {planned};
  if (!axes_->stopped()) {
    take_force(planned, line);
    axes_->cycle(planned,
                 {.line = line, .tool = tool_.tip, .force_n = to_link_ * force_n_, .bend_mm = to_link_ * bend_mm_});
  }
  TrueCycle seen{planned, bend_mm_};
  std::ranges::copy(axes_->joints(), seen.sample.position_set.begin());
  return seen;
}

std::string where(const gateway::StoppedByFault& stopped) {
  return stopped.line > 0 ? fmt::format("in line {}", stopped.line) : "before its program begins";
}

namespace {

Result<> joined(const std::vector<std::string>& clauses) {
  return clauses.empty() ? Result<>() : fail(fmt::format("{}", fmt::join(clauses, "; ")));
}

}  // namespace

Result<> keeps_to_program(const DynamicsWatch& watch) {
  std::vector<std::string> clauses;
  if (const auto& stopped = watch.axes().stopped()) {
    clauses.push_back(fmt::format("the machine stops {}: {}", where(*stopped), stopped->why));
  }
  if (const auto& off = watch.axes().deviation().off_path(); !off.empty()) {
    clauses.push_back(
        fmt::format("{} times the tool leaves its path by more than PositioningTolerance, first in line "
                    "{}: {:.3g} of {:.3g} mm",
                    off.size(), off.front().line, off.front().most_mm, off.front().allowed_mm));
  }
  for (const gateway::MotorTorque& motor : watch.axes().motor_torques()) {
    if (!motor.overheats()) continue;
    clauses.push_back(fmt::format("the motor at axis {} of {} gives {:.3g} N·m in the mean, and is made for {:.3g}",
                                  motor.axis, motor.bus, motor.rms_nm, motor.rated_nm));
  }
  return joined(clauses);
}

Result<> verdict(const DynamicsWatch& watch) {
  std::vector<std::string> clauses;
  if (const auto& found = watch.chatter().found(); !found.empty()) {
    const gateway::Chatter& first = found.front();
    clauses.push_back(fmt::format("{} cuts chatter, first in line {}: at {:.0f} Hz, from {:.0f} % of its depth on",
                                  found.size(), first.line, first.frequency_hz, 100 * first.share));
  }
  clauses.insert(clauses.end(), watch.not_told().begin(), watch.not_told().end());
  return both(keeps_to_program(watch), joined(clauses));
}

}  // namespace rmac::cli
