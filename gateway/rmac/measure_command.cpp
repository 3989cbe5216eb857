#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "gateway/api/decode.hpp"
#include "gateway/metrology/probe.hpp"
#include "gateway/metrology/tool_offset.hpp"
#include "gateway/rmac/authority.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/measuring_plan.hpp"
#include "gateway/rmac/prober.hpp"
#include "gateway/rmac/rest.hpp"
#include "gateway/rmac/table.hpp"
#include "gateway/rmac/tool_table.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {

namespace {

using gateway::FeatureDeviation;
using nlohmann::json;

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

Result<Frame> read_part_frame(Connection& connection) {
  const auto answer = connection.call("RMAC_CAM.GetPartFrame");
  if (!answer) return tl::unexpected(answer.error());
  Frame frame;
  answer->at("p").get_to(frame.p);
  answer->at("q").get_to(frame.q);
  return frame;
}

json to_json(const FeatureDeviation& deviation) {
  return {{"mean_mm", deviation.mean_mm}, {"rms_mm", deviation.rms_mm}, {"worst_mm", deviation.worst_mm}};
}

/// What a tool that cut measured features is off.
struct ToolFound {
  int number = 0;
  gateway::ToolOffset offset;
};

/// What came out, as it is told.
struct Report {
  std::vector<ToolFound> tools;
  std::vector<FeatureDeviation> before, after;
  std::optional<Frame> off;         ///< of the part from where it was taken to be
  std::optional<Frame> part_frame;  ///< in which the deviations are those of `after`
  std::string why_not;              ///< there is none
  bool applied = false;
};

/// The points of features that no tool is judged by; with `tool`, of those that this one cut.
std::vector<gateway::SurfacePoint> points_of(const MeasuringPlan& plan, std::optional<int> tool) {
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
  for (const int number : numbers) found.push_back({number, tool_offset(points_of(plan, number), part, axis)});
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
Result<std::vector<json>> corrected(Connection& connection, const std::vector<ToolFound>& found) {
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
Result<> apply(Connection& connection, const Report& report) {
  const auto tools = corrected(connection, report.tools);
  if (!tools) return tl::unexpected(tools.error());
  const auto set =
      connection.call("RMAC_CAM.SetPartFrame", {{"PartFrame", gateway::frame_to_json(*report.part_frame)}});
  if (!set) return tl::unexpected(set.error());
  for (const json& tool : *tools) {
    if (auto done = connection.call("RMAC_CAM.SetTool", tool); !done) return tl::unexpected(done.error());
  }
  return {};
}

json to_json(const std::optional<double>& value) {
  return value ? json(*value) : json();
}

void print_json(const MeasuringPlan& plan, const Report& report) {
  json features = json::array(), points = json::array();
  for (std::size_t i = 0; i < report.before.size(); ++i) {
    json feature{
        {"name", report.before[i].feature}, {"points", report.before[i].points}, {"before", to_json(report.before[i])}};
    feature["after"] = report.after.empty() ? json() : to_json(report.after[i]);
    features.push_back(std::move(feature));
  }
  for (const auto& point : plan.points) {
    json entry{
        {"feature", point.feature}, {"nominal", point.nominal}, {"normal", point.normal}, {"measured", point.measured}};
    if (report.off) {
      const auto one = gateway::feature_deviations({&point, 1}, *report.off);
      entry["in_part"] = apply_to_pose(inverse(*report.off), {point.measured, point.normal}).tip;
      entry["deviation_mm"] = one.front().mean_mm;
    }
    points.push_back(std::move(entry));
  }
  json line{{"features", std::move(features)}, {"points", std::move(points)}, {"applied", report.applied}};
  line["part_off"] = report.off ? gateway::frame_to_json(*report.off) : json();
  line["part_frame"] = report.part_frame ? gateway::frame_to_json(*report.part_frame) : json();
  if (!report.off) line["not_aligned"] = report.why_not;
  line["tools"] = json::array();
  for (const auto& [number, offset] : report.tools) {
    line["tools"].push_back({{"number", number},
                             {"length_off_mm", to_json(offset.length_mm)},
                             {"radius_off_mm", to_json(offset.radius_mm)}});
  }
  fmt::print("{}\n", line.dump());
}

void print_tools(const Report& report) {
  for (const auto& [tool, offset] : report.tools) {
    const auto mm = [](const std::optional<double>& value) { return value ? number(*value, 4) + " mm" : "not told"; };
    fmt::print("tool {}: longer than its table says by {}, its radius larger by {}\n", tool, mm(offset.length_mm),
               mm(offset.radius_mm));
  }
}

void print_table(const Report& report) {
  std::vector<std::vector<std::string>> rows;
  const auto um = [](double mm) { return number(1000 * mm, 3); };
  for (std::size_t i = 0; i < report.before.size(); ++i) {
    const FeatureDeviation& before = report.before[i];
    std::vector<std::string> row{before.feature, std::to_string(before.points), um(before.mean_mm),
                                 um(before.worst_mm)};
    const bool aligned = !report.after.empty();
    row.push_back(aligned ? um(report.after[i].mean_mm) : "-");
    row.push_back(aligned ? um(report.after[i].worst_mm) : "-");
    rows.push_back(std::move(row));
  }
  fmt::print("{}", table({"feature", "points", "mean µm", "worst µm", "aligned: mean µm", "worst µm"}, rows));
  if (!report.off) {
    fmt::print("\nnot aligned: {}\n", report.why_not);
    print_tools(report);
    return;
  }
  constexpr double kDegrees = 57.29577951308232;
  const auto& q = report.off->q;
  fmt::print("\nthe part is off by {}, {}, {} mm, and turned by {} degrees; {}\n", number(report.off->p[0], 4),
             number(report.off->p[1], 4), number(report.off->p[2], 4),
             number(kDegrees * 2 * std::atan2(std::hypot(q[1], q[2], q[3]), q[0]), 4),
             report.applied ? "its frame is in force" : "--apply puts its frame in force");
  print_tools(report);
}

}  // namespace

Result<> measure(Connection& connection, const MeasureRequest& request, bool json_wanted) {
  auto plan = read_measuring_plan(request.plan);
  if (!plan) return tl::unexpected(plan.error());
  Report report;
  auto done = with_authority(connection, [&]() -> Result<> {
    const auto frame = read_part_frame(connection);
    if (!frame) return tl::unexpected(frame.error());
    const auto tip_radius_mm = tip_radius(connection, *plan);
    if (!tip_radius_mm) return tl::unexpected(tip_radius_mm.error());
    if (auto measured = measure_all(connection, *plan, *tip_radius_mm); !measured) return measured;
    const auto stands = wait_for_rest(connection, "");
    if (!stands) return tl::unexpected(stands.error());
    const Vector axis{stands->pose[3], stands->pose[4], stands->pose[5]};
    report.before = gateway::feature_deviations(plan->points, {});
    const auto datums = points_of(*plan, std::nullopt);
    // With a plan for tools alone the part lies where it is taken to lie.
    const auto fit = datums.empty() ? Expected<Frame>() : gateway::fit_surfaces(datums);
    if (!fit) {
      report.why_not = fit.error().message;
      return request.apply ? fail(fmt::format("nothing is applied: {}", report.why_not)) : Result<>();
    }
    report.off = request.upright && !datums.empty() ? without_tilt(*fit, axis, datums) : *fit;
    report.part_frame = compose(*frame, *report.off);
    report.after = gateway::feature_deviations(plan->points, *report.off);
    report.tools = find_tools(*plan, *report.off, axis);
    if (!request.apply) return {};
    if (auto applied = apply(connection, report); !applied) return applied;
    report.applied = true;
    return {};
  });
  if (!done) return done;
  if (json_wanted) {
    print_json(*plan, report);
  } else {
    print_table(report);
  }
  return {};
}

}  // namespace rmac::cli
