#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gateway/metrology/probe.hpp"
#include "gateway/rmac/commands/measure/measure_report.hpp"
#include "gateway/rmac/commands/measure/registrations.hpp"
#include "gateway/rmac/measuring/part_frame.hpp"
#include "gateway/rmac/measuring/prober.hpp"
#include "gateway/rmac/measuring/tool_table.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {

namespace {

using nlohmann::json;

struct MeasureOptions {
  std::string plan;      ///< file
  bool apply = false;    ///< put the frame of the part as it was measured in force
  bool upright = false;  ///< a frame that is not tilted against the tool
};

/// Where the tip's centre is at a hit on the nominal point.
Vector tip_at(const gateway::SurfacePoint& point, double tip_radius_mm) {
  Vector place = point.nominal;
  for (std::size_t i = 0; i < 3; ++i) place[i] += tip_radius_mm * point.normal[i];
  return place;
}

Result<> measure_all(Connection& connection, MeasuringPlan& plan, double tip_radius_mm) {
  Prober prober(connection, plan.ways);
  if (auto begun = prober.begin(); !begun) return begun;
  for (gateway::SurfacePoint& point : plan.points) {
    const auto hit = prober.touch(tip_at(point, tip_radius_mm), point.normal);
    if (!hit) return tl::unexpected(hit.error());
    point.measured = gateway::touched_along_normal(*hit, point.normal, tip_radius_mm);
  }
  return prober.leave();
}

/// The plan's, or that of the probe in the spindle.
Result<double> tip_radius(Connection& connection, const MeasuringPlan& plan) {
  if (plan.tip_radius_mm) return *plan.tip_radius_mm;
  const auto probe = read_tool_in_spindle(connection);
  if (!probe) return fail(fmt::format("the plan gives no TipRadius, and {}", probe.error().message));
  return probe->at("Radius").get<double>();
}

/// The points of features that no tool is judged by; with `tool`, of those that this one cut.
std::vector<gateway::SurfacePoint> touched_points(const MeasuringPlan& plan, std::optional<int> tool) {
  std::vector<gateway::SurfacePoint> points;
  for (const auto& point : plan.points) {
    const auto cut = plan.cut_by.find(point.feature);
    const auto by = cut == plan.cut_by.end() ? std::nullopt : std::optional(cut->second);
    if (by == tool) points.push_back(point);
  }
  return points;
}

std::vector<ToolFound> find_tools(const MeasuringPlan& plan, const Frame& part, const Vector& axis) {
  std::set<int> numbers;
  for (const auto& [feature, number] : plan.cut_by) numbers.insert(number);
  std::vector<ToolFound> found;
  for (const int number : numbers) found.push_back({number, tool_offset(touched_points(plan, number), part, axis)});
  return found;
}

/// The frame without its tilt against `axis`, about the middle of the points: what a machine that cannot lean its tool
/// can follow.
Frame without_tilt(const Frame& frame, const Vector& axis, const std::vector<gateway::SurfacePoint>& points) {
  const auto& q = frame.q;
  const double along = q[1] * axis[0] + q[2] * axis[1] + q[3] * axis[2];
  const double length = std::hypot(q[0], along);
  Frame upright;
  upright.q = {q[0] / length, along * axis[0] / length, along * axis[1] / length, along * axis[2] / length};
  Vector middle{};
  for (const auto& point : points) {
    for (std::size_t i = 0; i < 3; ++i) middle[i] += point.nominal[i] / static_cast<double>(points.size());
  }
  const Vector there = apply_to_pose(frame, {middle, axis}).tip, turned = apply_to_pose(upright, {middle, axis}).tip;
  for (std::size_t i = 0; i < 3; ++i) upright.p[i] = there[i] - turned[i];
  return upright;
}

/// The tools of the table with what was found; nothing is set yet, so that one that is missing leaves all as they were.
Result<std::vector<json>> corrected_tools(Connection& connection, const std::vector<ToolFound>& found) {
  std::vector<json> tools;
  for (const auto& [number, offset] : found) {
    auto tool = read_tool(connection, number);
    if (!tool) return tl::unexpected(tool.error());
    (*tool)["Length"] = tool->at("Length").get<double>() + offset.length_mm.value_or(0);
    (*tool)["Radius"] = std::max(tool->at("Radius").get<double>() + offset.radius_mm.value_or(0), 0.0);
    tools.push_back(std::move(*tool));
  }
  return tools;
}

/// Puts frame and tools in force; a tool that is in the spindle has its new length at once.
Result<> apply(Connection& connection, const MeasureReport& report) {
  const auto tools = corrected_tools(connection, report.tools);
  if (!tools) return tl::unexpected(tools.error());
  if (auto set = set_part_frame(connection, *report.part_frame); !set) return set;
  for (const json& tool : *tools) {
    if (auto set = set_tool(connection, tool); !set) return set;
  }
  return {};
}

/// Fits the part to the measured points, and then the tools that cut it. `axis`: the tool's as it stands.
Result<> evaluate(const MeasuringPlan& plan, const Frame& frame, const Vector& axis, bool upright,
                  MeasureReport& report) {
  report.before = gateway::feature_deviations(plan.points, {});
  const auto datums = touched_points(plan, std::nullopt);
  // A plan for tools alone takes the part to lie where it is said to.
  const auto fit = datums.empty() ? Expected<Frame>() : gateway::fit_surfaces(datums);
  if (!fit) return fail(fit.error().message);
  report.off = upright && !datums.empty() ? without_tilt(*fit, axis, datums) : *fit;
  report.part_frame = compose(frame, *report.off);
  report.after = gateway::feature_deviations(plan.points, *report.off);
  report.tools = find_tools(plan, *report.off, axis);
  return {};
}

Result<MeasureReport> measure_and_apply(Connection& connection, MeasuringPlan& plan, const MeasureOptions& options) {
  const auto frame = read_part_frame(connection);
  if (!frame) return tl::unexpected(frame.error());
  const auto tip_radius_mm = tip_radius(connection, plan);
  if (!tip_radius_mm) return tl::unexpected(tip_radius_mm.error());
  if (auto measured = measure_all(connection, plan, *tip_radius_mm); !measured) {
    return tl::unexpected(measured.error());
  }
  const auto stands = wait_for_rest(connection, "");
  if (!stands) return tl::unexpected(stands.error());
  MeasureReport report;
  const auto evaluated =
      evaluate(plan, *frame, {stands->pose[3], stands->pose[4], stands->pose[5]}, options.upright, report);
  if (!evaluated) report.why_not = evaluated.error().message;
  if (!options.apply) return report;
  if (!evaluated) return fail(fmt::format("nothing is applied: {}", report.why_not));
  if (auto applied = apply(connection, report); !applied) return tl::unexpected(applied.error());
  report.applied = true;
  return report;
}

/// Measures the points of a plan, and tells how far the part and its features are off.
Result<> measure(Connection& connection, const MeasureOptions& options, bool json_wanted) {
  auto plan = read_measuring_plan(options.plan);
  if (!plan) return tl::unexpected(plan.error());
  MeasureReport report;
  const auto done = with_authority(connection, [&] {
    return measure_and_apply(connection, *plan, options).map([&](MeasureReport found) { report = std::move(found); });
  });
  if (!done) return done;
  if (json_wanted) {
    print_json(*plan, report);
  } else {
    print_table(report);
  }
  return {};
}

}  // namespace

void add_measure(Command& rmac) {
  const auto options = std::make_shared<MeasureOptions>();
  Command measured = rmac.add("measure", "measure the points of a plan: where the part lies, how far it is off");
  measured.option("PLAN", &options->plan, "the measuring plan, a JSON file").required();
  measured.flag("--apply", &options->apply, "set the part frame to where the part lies; without it nothing is set");
  measured.flag("--upright", &options->upright,
                "leave out the part's tilt against the tool's axis, which a machine of slides cannot follow");
  measured.does(
      with_appliance([options](Connection& appliance, bool json) { return measure(appliance, *options, json); }));
}

}  // namespace rmac::cli
