#include "gateway/rmac/view/film.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>
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

struct PlotKind {
  const char* name;
  const char* unit;
  double tolerance;
  int digits;
};
constexpr std::array<PlotKind, 5> kPlots{{{"feed", "mm/min", 5, 1},
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

Film::Film(const ShapedMachine& machine, const CollisionWatch* watch, DrawnBodies drawn)
    : machine_(machine),
      watch_(watch),
      drawn_(std::move(drawn)),
      links_(machine.chain, base_of(machine), reaches(machine, drawn_.bodies)) {
  for (const PlotKind& kind : kPlots) plots_.push_back({ThinnedTrack<double, NumberWay>(kind.tolerance)});
}

void Film::cycle(const gateway::CycleSample& sample, const Now& now) {
  const sdk::DeviceObject* const device = now.controller.mechanism();
  if (device == nullptr || device->name != machine_.name) {
    if (device != nullptr && sample.moving) {
      not_shown_.insert(fmt::format("moves of {}: this is {}", device->name, machine_.name));
    }
    return;
  }
  begun_ = begun_ || sample.moving;
  if (!begun_) return;
  if (std::exchange(look_at_tool_, false)) take_tool(sample.t_s, now.controller);
  const auto joints = std::span(sample.position_set).first(sample.joint_count);
  joints_.assign(joints.begin(), joints.end());
  now_s_ = sample.t_s;
  // Rounding of the cycles' times must not put a look off by a cycle.
  constexpr double kSoonEnough = 1e-9;
  if (sample.t_s < next_s_ - kSoonEnough) return;
  next_s_ = std::max(next_s_ + 1 / kLooks_per_s, sample.t_s + 0.5 / kLooks_per_s);
  look(sample.t_s, sample, now);
}

void Film::look(double t_s, const gateway::CycleSample& sample, const Now& now) {
  if (links_.keys() == 0) from_s_ = t_s;
  to_s_ = t_s;
  links_.add(t_s, joints_);
  constexpr double kSecondsPerMinute = 60;
  if (watch_ != nullptr && watch_->material() != nullptr) stocks_.look(t_s, *watch_->material());
  plot(Feed, t_s, sample.moving ? sample.feed_set_mm_s * kSecondsPerMinute : 0);
  plot(Spindle, t_s, sample.spindle_rpm.front());
  if (watch_ != nullptr && watch_->load() != nullptr) {
    const gateway::CuttingNow cutting = watch_->load()->now(t_s);
    plot(Force, t_s, cutting.n);
    plot(Torque, t_s, cutting.nm);
    plot(Power, t_s, cutting.w);
  }
  lines_.add(t_s, now.line);
  const std::string limit = now.account.rules_now();
  const auto known = std::ranges::find(limit_names_, limit);
  limits_.add(t_s, static_cast<int>(known - limit_names_.begin()));
  if (known == limit_names_.end()) limit_names_.push_back(limit);
}

void Film::plot(Plot which, double t_s, double value) {
  Plotted& plotted = plots_[which];
  plotted.any = plotted.any || value != 0;
  plotted.track.add(t_s, value);
  while (plotted.track.keys().size() > kMostOfPlot) plotted.track.coarsen();
}

void Film::take_tool(double t_s, gateway::Controller& controller) {
  Json tool = drawn_tool(mounted_tool(controller), machine_.chain);
  std::string text = tool.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto known = std::ranges::find(tools_known_, text);
  tool_at_.add(t_s, static_cast<int>(known - tools_known_.begin()));
  if (known != tools_known_.end()) return;
  tools_.push_back(std::move(tool));
  tools_known_.push_back(std::move(text));
}

void Film::end() {
  if (now_s_ > to_s_ && begun_) links_.add(to_s_ = now_s_, joints_);
  links_.end();
  for (Plotted& plotted : plots_) plotted.track.end();
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
  Json plots = Json::array();
  for (std::size_t i = 0; i < plots_.size(); ++i) {
    if (!plots_[i].any) continue;
    std::vector<double> times, values;
    for (const auto& [t_s, value] : plots_[i].track.keys()) times.push_back(t_s), values.push_back(value);
    plots.push_back({{"name", kPlots[i].name},
                     {"unit", kPlots[i].unit},
                     {"t", rounded(times, kTimeDigits)},
                     {"is", rounded(values, kPlots[i].digits)}});
  }
  Json limits = steps_json(limits_);
  limits["names"] = limit_names_;
  return {{"machine", machine_.name},
          {"from_s", rounded(from_s_, kTimeDigits)},
          {"to_s", rounded(to_s_, kTimeDigits)},
          {"looks_per_s", kLooks_per_s},
          {"within_mm", within_mm()},
          {"meshes_coarser_mm", drawn_.coarser_mm},
          {"links", std::move(links)},
          {"bodies", std::move(bodies)},
          {"stocks", stocks_.to_json()},
          {"tools", tools_},
          {"tool_at", steps_json(tool_at_)},
          {"lines", steps_json(lines_)},
          {"limits", std::move(limits)},
          {"plots", std::move(plots)},
          {"not_shown", not_shown_}};
}

}  // namespace rmac::cli
