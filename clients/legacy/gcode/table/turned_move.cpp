#include "clients/legacy/gcode/table/turned_move.hpp"

#include <cmath>
#include <numbers>

namespace rmac::gcode {

double minutes_of(const TableMove& move, const TurnedWay& way, const FeedModes& feed, std::size_t place) {
  const auto& [options, rules, modes] = feed;
  const double straight = legacy::length(legacy::difference(move.to, move.from));
  if (modes.inverse_time) {
    const double counted = straight > 0 ? straight : way.turn_degrees;
    return counted / modes.feed_over(counted, place);
  }
  if (modes.feed_mm_min == 0) refuse(place, "no feed was set before this move; write F");
  const double straight_min = straight / modes.feed_mm_min;
  const double degree_min = options.rotary_diameter_mm
                                ? *options.rotary_diameter_mm * std::numbers::pi / 360 / modes.feed_mm_min
                                : 1 / modes.feed_degrees_min;
  const double turning_min = way.turn_degrees * degree_min;
  if (rules.degrees_are_lengths) return std::hypot(straight_min, turning_min);
  return straight_min > 0 ? straight_min : turning_min;
}

void write(const TurnedWay& way, Writer& writer) {
  for (const TurnedPiece& piece : way.pieces) {
    if (const auto* line = std::get_if<TurnedLine>(&piece)) {
      writer.tool_axis(line->axis);
      writer.line(line->end);
    } else if (const auto* arc = std::get_if<TurnedArc>(&piece)) {
      writer.tool_axis(arc->axis);
      writer.arc(arc->arc);
    } else {
      const auto& spline = std::get<legacy::PoseSpline>(piece);
      const auto& end = spline.points.back();
      writer.tool_axis({end[3], end[4], end[5]});
      writer.pose_spline(spline);
    }
  }
}

}  // namespace rmac::gcode
