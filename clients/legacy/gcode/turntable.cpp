#include "clients/legacy/gcode/turntable.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clients/legacy/gcode/modes/turns.hpp"

namespace rmac::gcode {

namespace {

constexpr int kPositioning = 0, kStraight = 10, kFirstCycle = 730;
constexpr double kTurn_degrees = 360;

}  // namespace

bool is_upright(const RotaryAxis& axis, const KnownAngles& angles) {
  return std::fmod(angles.at(index_of(axis.letter)).value_or(0), kTurn_degrees) == 0;
}

TableAngles zeros_for_unknown(const KnownAngles& angles) {
  return {angles[0].value_or(0), angles[1].value_or(0), angles[2].value_or(0)};
}

bool Turntable::carries(const KnownAngles& angles) const {
  const auto is_upright_or_table = [&angles](const RotaryAxis& axis) {
    return axis.centre_mm || is_upright(axis, angles);
  };
  const auto is_table = [](const RotaryAxis& axis) { return axis.centre_mm.has_value(); };
  return std::ranges::any_of(options_.rotary, is_table) && std::ranges::all_of(options_.rotary, is_upright_or_table);
}

double Turntable::led(const RotaryAxis& axis, double from, const Word& word, double degrees) const {
  if (!axis.centre_mm || !in_force() || !coordinates_.tip_is_known()) return degrees;
  const bool written = rules_.turns_as_written || std::abs(degrees - from) <= kTurn_degrees / 2;
  if (options_.rotary_way == RotaryWay::Shorter) return from + std::remainder(degrees - from, kTurn_degrees);
  if (!options_.rotary_way && !written)
    refuse(
        word.place,
        fmt::format("from {0}{1:.6g} that is more than half a turn, which some controls go as the numbers have it and "
                    "others the shorter way round; give --rotary-way written or --rotary-way shorter",
                    axis.letter, from));
  return degrees;
}

Table Turntable::table(std::size_t place) const {
  const auto found = options_.offsets.find(0);
  const Known begin = found == options_.offsets.end() ? Known{} : found->second;
  const Known& now = coordinates_.offset(coordinates_.active());
  Table table;
  for (const RotaryAxis& rotary : options_.rotary) {
    TableAxis axis{index_of(rotary.letter), plane_of(rotary.letter), rotary.sign, rotary.centre_mm.value_or(Point{})};
    for (std::size_t i = 0; i < axis.centre.size(); ++i) {
      const auto &was = begin.at(i), &is = now.at(i);
      if (was == is || i == axis.plane.normal) continue;
      if (!was || !is)
        refuse(place,
               "--rotary-centre is in the coordinates of the begin, and where they are in those in force is not known; "
               "give --offset G54=X,Y,Z");
      axis.centre.at(i) += *was - *is;
    }
    table.push_back(axis);
  }
  return table;
}

std::optional<legacy::Placement> Turntable::placement(const KnownAngles& angles, std::size_t place) const {
  if (!in_force() || !carries(angles) || angles == KnownAngles{}) return std::nullopt;
  const auto placement = placement_of(table(place), zeros_for_unknown(angles));
  return placement == legacy::Placement{} ? std::nullopt : std::optional(placement);
}

void Turntable::turn(const std::optional<TableAngles>& begin, const TableAngles& end, int motion, std::size_t place) {
  const auto turns = [&end, &begin](const RotaryAxis& axis) {
    return std::abs(end.at(index_of(axis.letter)) - begin->at(index_of(axis.letter))) > kMostTableTurns * kTurn_degrees;
  };
  if (motion == Modes::kNoMotion) refuse(place, "no G0 or G1 is in force that could use this");
  const bool positions = motion == kPositioning || motion >= kFirstCycle;
  if (!positions && motion != kStraight) refuse(place, "what turns a table is a G0 or G1; write that into this block");
  if (motion >= kFirstCycle && !rules_.cycles.may_turn)
    refuse(place, "a table turns by a G0 between holes; write G80 and that before this");
  if (begin && std::ranges::any_of(options_.rotary, turns))
    refuse(place, fmt::format("more than {} turns in one move", kMostTableTurns));
  if (!begin && !positions) refuse(place, "where the table stands before this is not known here; turn it by G0 first");
  if (begin && !positions) static_cast<void>(mover_.start(place));
  const Table table = this->table(place);
  if (begin && coordinates_.tip_is_known()) return mover_.turn_with_next(table, *begin, end);
  const legacy::Placement placement = placement_of(table, end);
  coordinates_.turn(placement);
  mover_.turn_unseen(placement.z);
}

void Turntable::settle(const KnownAngles& angles, std::size_t place) {
  coordinates_.see_from(placement(angles, place));
}

void Turntable::follow(const KnownAngles& angles, std::size_t place) {
  coordinates_.turn(placement(angles, place));
}

}  // namespace rmac::gcode
