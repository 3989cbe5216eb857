#include "gateway/rmac/view/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/bodies/link.hpp"
#include "gateway/rmac/simulator/mounted_tool.hpp"
#include "gateway/rmac/view/rounded.hpp"

namespace rmac::cli {
namespace {

using Json = nlohmann::json;
using Eigen::Vector3d;

/// Tools are longer than nothing, and nobody knows yet which there will be.
constexpr double kReachOfTools_mm = 300;

struct LookedAt {
  const char* name;
  const char* unit;
  double tolerance;
  int digits;
};
constexpr std::array<LookedAt, 5> kLookedAt{{{"feed", "mm/min", 5, 1},
                                             {"spindle", "rpm", 1, 0},
                                             {"force", "N", 0.5, 2},
                                             {"torque", "N·m", 0.005, 4},
                                             {"power", "W", 0.5, 2}}};

/// A ball about all that stands on each link.
std::vector<Reach> reaches(const ShapedMachine& machine, const std::vector<DrawnBody>& bodies) {
  const std::size_t count = machine.chain.link_count();
  std::vector<std::vector<Reach>> on(count);
  for (const DrawnBody& body : bodies) on[body.link].push_back(body.reach);
  const Vector& interface = machine.chain.interface_home().p;
  on[count - 1].push_back({Vector3d(interface[0], interface[1], interface[2]), kReachOfTools_mm});
  std::vector<Reach> found(count);
  for (std::size_t k = 0; k < count; ++k) {
    Eigen::AlignedBox3d box;
    for (const Reach& each : on[k]) box.extend(each.middle);
    if (on[k].empty()) continue;
    found[k].middle = box.center();
    for (const Reach& each : on[k]) {
      found[k].radius = std::max(found[k].radius, (each.middle - found[k].middle).norm() + each.radius);
    }
  }
  return found;
}

std::size_t base_of(const ShapedMachine& machine) {
  return gateway::link_number(machine.bodies.chain, gateway::kBase).value_or(0);
}

Json steps_json(const StepTrack& track) {
  return {{"t", rounded(track.t_s(), kTimeDigits)}, {"is", track.values()}, {"apart_s", track.apart_s()}};
}

}  // namespace

Film::Film(const ShapedMachine& machine, const CollisionWatch* watch, gateway::AxisDynamics* axes, DrawnBodies drawn)
    : machine_(machine),
      watch_(watch),
      drawn_(std::move(drawn)),
      links_(machine.chain, base_of(machine), reaches(machine, drawn_.bodies)) {
  for (const auto& [name, unit, tolerance, digits] : kLookedAt) plots_.start({name, name, unit, tolerance, digits});
  if (axes != nullptr) dynamics_.emplace(*axes, plots_);
}

void Film::cycle(const gateway::CycleSample& planned, const Now& now) {
  const sdk::DeviceObject* const device = now.controller.mechanism();
  if (device == nullptr || device->name != machine_.name) {
    if (device != nullptr && planned.moving) {
      not_shown_.insert(fmt::format("moves of {}: this is {}", device->name, machine_.name));
    }
    return;
  }
  begun_ = begun_ || planned.moving;
  if (!begun_) return;
  if (std::exchange(look_at_tool_, false)) take_tool(planned.t_s, now.controller);
  joints_.assign(now.joints.begin(), now.joints.end());
  now_s_ = planned.t_s;
  if (dynamics_) dynamics_->cycle(planned);
  // Rounding of the cycles' times must not put a look off by a cycle.
  constexpr double kSoonEnough = 1e-9;
  if (planned.t_s < next_s_ - kSoonEnough) return;
  next_s_ = std::max(next_s_ + 1 / kLooks_per_s, planned.t_s + 0.5 / kLooks_per_s);
  look(planned.t_s, planned, now);
}

void Film::look(double t_s, const gateway::CycleSample& planned, const Now& now) {
  if (links_.keys() == 0) from_s_ = t_s;
  to_s_ = t_s;
  links_.add(t_s, joints_);
  constexpr double kSecondsPerMinute = 60;
  if (watch_ != nullptr && watch_->material() != nullptr) stocks_.look(t_s, *watch_->material());
  plots_.add(Feed, t_s, planned.moving ? planned.feed_set_mm_s * kSecondsPerMinute : 0);
  plots_.add(Spindle, t_s, planned.spindle_rpm.front());
  if (watch_ != nullptr && watch_->load() != nullptr) {
    const gateway::CuttingNow cutting = watch_->load()->now(t_s);
    plots_.add(Force, t_s, cutting.n);
    plots_.add(Torque, t_s, cutting.nm);
    plots_.add(Power, t_s, cutting.w);
  }
  lines_.add(t_s, now.line);
  limits_.add(t_s, now.account.rules_now());
}

void Film::take_tool(double t_s, gateway::Controller& controller) {
  const Json tool = drawn_tool(mounted_tool(controller), machine_.chain);
  tools_.add(t_s, tool.dump(-1, ' ', false, Json::error_handler_t::replace));
}

void Film::end() {
  if (now_s_ > to_s_ && begun_) links_.add(to_s_ = now_s_, joints_);
  links_.end();
  plots_.end();
}

Json Film::to_json() const {
  Json links = Json::array();
  for (std::size_t k = 0; k < machine_.chain.link_count(); ++k) {
    Json names = Json::array();
    for (const std::string& name : machine_.bodies.chain) {
      if (gateway::link_number(machine_.bodies.chain, name) == k) names.push_back(name);
    }
    links.push_back(links_.to_json(k));
    links.back()["names"] = std::move(names);
  }
  Json bodies = Json::array();
  for (const DrawnBody& body : drawn_.bodies) bodies.push_back(body.json);
  Json tools = Json::array();
  for (const std::string& tool : tools_.names()) tools.push_back(Json::parse(tool));
  Json limits = steps_json(limits_.steps());
  limits["names"] = limits_.names();
  return {{"machine", machine_.name},
          {"from_s", rounded(from_s_, kTimeDigits)},
          {"to_s", rounded(to_s_, kTimeDigits)},
          {"looks_per_s", kLooks_per_s},
          {"within_mm", within_mm()},
          {"meshes_coarser_mm", drawn_.coarser_mm},
          {"links", std::move(links)},
          {"bodies", std::move(bodies)},
          {"stocks", stocks_.to_json()},
          {"tools", std::move(tools)},
          {"tool_at", steps_json(tools_.steps())},
          {"lines", steps_json(lines_)},
          {"limits", std::move(limits)},
          {"plots", plots_.to_json()},
          {"not_shown", not_shown_}};
}

}  // namespace rmac::cli
