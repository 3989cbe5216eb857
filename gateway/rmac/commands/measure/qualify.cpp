#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "gateway/metrology/probe.hpp"
#include "gateway/rmac/commands/measure/registrations.hpp"
#include "gateway/rmac/measuring/part_frame.hpp"
#include "gateway/rmac/measuring/prober.hpp"
#include "gateway/rmac/measuring/tool_table.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/rest.hpp"

namespace rmac::cli {
namespace {

using gateway::ProbeQualification;
using nlohmann::json;

/// A reference sphere, and the probe that touches it. Part frame, mm.
struct QualifyOptions {
  std::vector<double> sphere;           ///< its centre and its radius
  std::optional<double> tip_radius_mm;  ///< about; none: that of the tool in the spindle
  double clearance_mm = 5;
  double speed_mm_s = 20;
  bool apply = false;  ///< correct the tool in the spindle
};

/// From where the sphere is touched: its top, and two rings about it that are clear of the stem it stands on.
std::vector<Vector> directions() {
  constexpr int kOfRing = 6;
  constexpr double kRad = std::numbers::pi / 180;
  std::vector<Vector> all{{0, 0, 1}};
  for (const double elevation : {45.0, 10.0}) {
    for (int i = 0; i < kOfRing; ++i) {
      const double around = 2 * std::numbers::pi * i / kOfRing, level = std::cos(elevation * kRad);
      all.push_back({level * std::cos(around), level * std::sin(around), std::sin(elevation * kRad)});
    }
  }
  return all;
}

Vector beside(const QualifyOptions& options, const Vector& direction, double distance_mm) {
  Vector place{};
  for (std::size_t i = 0; i < 3; ++i) place[i] = options.sphere[i] + distance_mm * direction[i];
  return place;
}

/// The offset is found in the part frame, and the tool sits on the tool interface: with every turn at zero that stands
/// as the machine does.
Result<> require_turns_at_zero(Connection& connection, const std::vector<double>& joints) {
  constexpr double kSame_deg = 0.01;
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    const auto type = connection.call("Device.Machine_GetMechanismJntTypes", {{"JntNum", joint}});
    if (!type) return tl::unexpected(type.error());
    if (*type == 0 && std::abs(joints[joint]) > kSame_deg) {
      return fail(
          fmt::format("joint {} stands at {:.4f} degrees: a probe's offset is put into the tool table with every "
                      "turn at 0, where the tool interface stands as the machine does; `rmac home`, then again",
                      joint, joints[joint]));
    }
  }
  return {};
}

/// The tool with its tip where it was found: the length takes what lies along the tool, its frame the rest.
Result<json> corrected_probe(Connection& connection, json tool, const ProbeQualification& found) {
  const auto part = read_part_frame(connection);
  if (!part) return tl::unexpected(part.error());
  Frame turned, seat;
  turned.q = part->q;
  tool.at("Frame").at("q").get_to(seat.q);
  const Vector offset = apply_to_pose(turned, {found.offset, {0, 0, 1}}).tip;
  const Vector along = z_axis(seat);
  const double longer = -(offset[0] * along[0] + offset[1] * along[1] + offset[2] * along[2]);
  auto& place = tool.at("Frame").at("p");
  for (std::size_t i = 0; i < 3; ++i) place[i] = place[i].get<double>() + offset[i] + longer * along[i];
  tool["Length"] = tool.at("Length").get<double>() + longer;
  tool["Radius"] = found.tip_radius_mm;
  return tool;
}

Result<ProbeQualification> touch_all(Connection& connection, const QualifyOptions& options, double tip_radius_mm) {
  const double radius_mm = options.sphere[3];
  Prober prober(connection, {options.sphere[2] + radius_mm + tip_radius_mm + options.clearance_mm, options.clearance_mm,
                             options.speed_mm_s});
  if (auto begun = prober.begin(); !begun) return tl::unexpected(begun.error());
  std::vector<Vector> hits;
  for (const Vector& direction : directions()) {
    const auto hit = prober.touch(beside(options, direction, radius_mm + tip_radius_mm), direction);
    if (!hit) return tl::unexpected(hit.error());
    hits.push_back(*hit);
  }
  if (auto left = prober.leave(); !left) return tl::unexpected(left.error());
  const auto found = gateway::qualify_probe(hits, beside(options, {}, 0), radius_mm);
  return found ? Result<ProbeQualification>(*found) : fail(found.error().message);
}

void print(const ProbeQualification& found, const json& tool, bool applied, bool json_wanted) {
  const auto& offset = found.offset;
  if (json_wanted) {
    const json line{{"tip_radius_mm", found.tip_radius_mm},
                    {"offset_mm", offset},
                    {"rms_mm", found.quality.rms_mm},
                    {"worst_mm", found.quality.worst_mm},
                    {"points", found.quality.points},
                    {"tool", tool.is_null() ? json() : tool.at("ToolNumber")},
                    {"applied", applied}};
    fmt::print("{}\n", line.dump());
    return;
  }
  fmt::print(
      "the tip's radius is {} mm, and its centre {}, {}, {} mm from where it was taken to be; the hits lie "
      "within {} µm of a sphere; {}\n",
      number(found.tip_radius_mm, 4), number(offset[0], 4), number(offset[1], 4), number(offset[2], 4),
      number(1000 * found.quality.worst_mm, 3),
      applied ? fmt::format("tool {} is corrected by it", tool.at("ToolNumber").dump())
              : "--apply corrects the tool in the spindle by it");
}

/// Touches a sphere that is known, and tells the radius of the probe's tip and how far its centre is off.
Result<> qualify(Connection& connection, const QualifyOptions& options, bool json_wanted) {
  return with_authority(connection, [&]() -> Result<> {
    json tool;
    if (options.apply || !options.tip_radius_mm) {
      auto mounted = read_tool_in_spindle(connection);
      if (!mounted) return tl::unexpected(mounted.error());
      tool = std::move(*mounted);
    }
    const auto stands = wait_for_rest(connection, "");
    if (!stands) return tl::unexpected(stands.error());
    if (options.apply) {
      if (auto zero = require_turns_at_zero(connection, stands->joints); !zero) return zero;
    }
    const double tip_radius_mm = options.tip_radius_mm ? *options.tip_radius_mm : tool.at("Radius").get<double>();
    const auto found = touch_all(connection, options, tip_radius_mm);
    if (!found) return tl::unexpected(found.error());
    if (options.apply) {
      const auto better = corrected_probe(connection, tool, *found);
      if (!better) return tl::unexpected(better.error());
      if (auto set = set_tool(connection, *better); !set) return set;
    }
    print(*found, tool, options.apply, json_wanted);
    return {};
  });
}

}  // namespace

void add_qualify(Command& rmac) {
  const auto options = std::make_shared<QualifyOptions>();
  Command qualified =
      rmac.add("qualify", "touch a sphere that is known: the radius of the probe's tip, and how far it is off");
  qualified.option("--sphere", &options->sphere, "its centre, x y z, and its radius, in the part frame, mm")
      .required()
      .takes(4);
  qualified.option("--tip-radius", &options->tip_radius_mm, "about, mm; that of the tool in the spindle unless given")
      .within(0.0, 100.0);
  qualified.option("--clearance", &options->clearance_mm, "off the sphere where it begins to measure a point, mm")
      .within(0.1, 1000.0)
      .shows_default();
  qualified.option("--speed", &options->speed_mm_s, "between points, and towards them, mm/s")
      .within(0.01, 1000.0)
      .shows_default();
  qualified.flag("--apply", &options->apply, "correct the tool in the spindle; without it nothing is set");
  qualified.does(
      with_appliance([options](Connection& appliance, bool json) { return qualify(appliance, *options, json); }));
}

}  // namespace rmac::cli
