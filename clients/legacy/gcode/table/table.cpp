#include "clients/legacy/gcode/table/table.hpp"

#include <numbers>

#include "clients/legacy/gcode/modes/turns.hpp"

namespace rmac::gcode {

namespace {

using legacy::Placement;

Placement turn_of(const TableAxis& axis, double degrees) {
  return turn_about_normal(axis.plane, axis.sign * degrees);
}

/// `jet` turned about an axis through `centre`, at `rate` radians a share: the turn keeps its axis, so derivatives may
/// be turned last.
Jet turned(const Jet& jet, const Placement& turn, const legacy::Point& rate, const legacy::Point& centre) {
  const legacy::Point arm = legacy::difference(jet.at, centre), across = legacy::cross(rate, arm);
  return {legacy::along(turn.turned(arm), 1, centre), turn.turned(legacy::along(jet.first, 1, across)),
          turn.turned(legacy::along(legacy::along(jet.second, 2, legacy::cross(rate, jet.first)), 1,
                                    legacy::cross(rate, across)))};
}

Jet on_part(const Table& table, const TableMove& move, double share, Jet jet, bool is_point) {
  for (auto at = table.rbegin(); at != table.rend(); ++at) {
    const TableAxis& axis = *at;
    const double begin = move.begin.at(axis.angle), way = move.end.at(axis.angle) - begin;
    const double rate = axis.sign * way * std::numbers::pi / 180;
    const double degrees = share == 1 ? move.end.at(axis.angle) : begin + share * way;
    jet = turned(jet, turn_of(axis, degrees), legacy::scaled(rate, legacy::unit_axis(axis.plane.normal)),
                 is_point ? axis.centre : legacy::Point{});
  }
  return jet;
}

}  // namespace

Placement placement_of(const Table& table, const TableAngles& angles) {
  Placement all;
  for (auto at = table.rbegin(); at != table.rend(); ++at) {
    const TableAxis& axis = *at;
    Placement turn = turn_of(axis, angles.at(axis.angle));
    turn.shift = legacy::difference(axis.centre, turn.turned(axis.centre));
    all = turn.after(all);
  }
  return all;
}

Jet tip_at(const Table& table, const TableMove& move, double share) {
  const legacy::Point way = legacy::difference(move.to, move.from);
  const legacy::Point at = share == 1 ? move.to : legacy::along(move.from, share, way);
  return on_part(table, move, share, {at, way, {}}, true);
}

Jet axis_at(const Table& table, const TableMove& move, double share) {
  return on_part(table, move, share, {legacy::unit_axis(2), {}, {}}, false);
}

}  // namespace rmac::gcode
