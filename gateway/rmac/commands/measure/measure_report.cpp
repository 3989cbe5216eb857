#include "gateway/rmac/commands/measure/measure_report.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gateway/api/decode.hpp"
#include "gateway/rmac/terminal/table.hpp"

namespace rmac::cli {

namespace {

using gateway::FeatureDeviation;
using nlohmann::json;

json to_json(const FeatureDeviation& deviation) {
  return {{"mean_mm", deviation.mean_mm}, {"rms_mm", deviation.rms_mm}, {"worst_mm", deviation.worst_mm}};
}

json to_json(const std::optional<double>& value) {
  return value ? json(*value) : json();
}

json features_of(const MeasureReport& report) {
  json features = json::array();
  for (std::size_t i = 0; i < report.before.size(); ++i) {
    json feature{
        {"name", report.before[i].feature}, {"points", report.before[i].points}, {"before", to_json(report.before[i])}};
    feature["after"] = report.after.empty() ? json() : to_json(report.after[i]);
    features.push_back(std::move(feature));
  }
  return features;
}

json points_json(const MeasuringPlan& plan, const MeasureReport& report) {
  json points = json::array();
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
  return points;
}

std::vector<std::vector<std::string>> rows_of(const MeasureReport& report) {
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
  return rows;
}

void print_tools(const MeasureReport& report) {
  for (const auto& [tool, offset] : report.tools) {
    const auto mm = [](const std::optional<double>& value) { return value ? number(*value, 4) + " mm" : "not told"; };
    fmt::print("tool {}: longer than its table says by {}, its radius larger by {}\n", tool, mm(offset.length_mm),
               mm(offset.radius_mm));
  }
}

}  // namespace

void print_json(const MeasuringPlan& plan, const MeasureReport& report) {
  json line{{"features", features_of(report)}, {"points", points_json(plan, report)}, {"applied", report.applied}};
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

void print_table(const MeasureReport& report) {
  fmt::print("{}",
             table({"feature", "points", "mean µm", "worst µm", "aligned: mean µm", "worst µm"}, rows_of(report)));
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

}  // namespace rmac::cli
