#include "clients/legacy/gcode/motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clients/legacy/gcode/modes/offsets.hpp"

namespace rmac::gcode {

namespace {

/// What the API takes of whole turns more, and the arc's own.
constexpr int kMostTurns = 1001;

int turns_of(const Word& word) {
  const double nearest = std::round(word.value);
  if (nearest != word.value || nearest < 1 || nearest > kMostTurns) {
    refuse(word.place, fmt::format("P of an arc is its turns, 1 to {}", kMostTurns));
  }
  return static_cast<int>(nearest);
}

}  // namespace

double Motions::reference_value(const Point& reference, std::size_t axis, std::size_t place) const {
  const double value = reference.at(axis);
  if (!rules_.reference_is_zero) return value;
  const auto found = options_.offsets.find(0);
  const auto begin = found == options_.offsets.end() ? std::nullopt : found->second.at(axis);
  const auto& now = coordinates_.offset(coordinates_.active()).at(axis);
  if (begin == now) return value;
  if (!begin || !now)
    refuse(place,
           "--reference-point is in the coordinates of the begin, and where they are in those in force is not known; "
           "give --offset G54=X,Y,Z, or write the way there as G0");
  return value + *begin - *now;
}

double Motions::machine_value(const Word& word, std::size_t axis) const {
  require_unplaced(coordinates_, word.place);
  if (modes_.incremental) refuse(word.place, "G53 under G91; write G90 before it");
  const auto& offset = coordinates_.offset(coordinates_.active()).at(axis);
  const bool is_reference = rules_.reference_is_zero || (options_.reference_mm && (axis == 2 || !offset));
  if (is_reference && word.value == 0) {
    if (options_.reference_mm) {
      constexpr double kSame_mm = 1e-6;
      const double value = reference_value(*options_.reference_mm, axis, word.place);
      const auto& zero = coordinates_.offset(coordinates_.active()).at(axis);
      // Z is the tip's, and that of the spindle in the offset.
      if (rules_.reference_is_zero && axis != 2 && zero && !(std::abs(value + *zero) <= kSame_mm))
        refuse(word.place, fmt::format("--offset has the machine's zero at {0}{1:.6g}, and --reference-point the "
                                       "reference point at {0}{2:.6g}; write the way there without G53",
                                       kAxisLetters.at(axis), 0.0 - *zero, value));
      return value;
    }
    refuse(word.place,
           "where the machine's zero is, in the coordinates of the part, is not known here; give --reference-point "
           "X,Y,Z, or write the way there without G53");
  }
  if (!offset) {
    refuse(word.place,
           "where the work system is in the machine is not known, so neither is this place; write it without G53, "
           "set the system by G10 L2, or give --offset");
  }
  if (axis == 2) {
    refuse(word.place,
           "machine Z is that of the spindle without its tool, whose length is not known here; write Z without G53, or "
           "Z0 and give --reference-point X,Y,Z");
  }
  return modes_.mm(word) - *offset;
}

Point Motions::end_of(Block& block, std::size_t place) {
  const bool in_machine = block.once(530);
  const bool all = std::ranges::all_of(
      kAxisLetters, [&block](char letter) { return block.has(letter) && !block.use(letter).relative; });
  Point end{};
  if (!all || modes_.incremental) end = start(place);
  for (std::size_t axis = 0; axis < end.size(); ++axis) {
    const Word* word = block.find(kAxisLetters.at(axis));
    if (word == nullptr) continue;
    double& value = end.at(axis);
    if (in_machine) {
      value = machine_value(*word, axis);
    } else {
      value = modes_.incremental || word->relative ? value + modes_.mm(*word)
                                                   : coordinates_.to_part(axis, modes_.mm(*word));
    }
  }
  return end;
}

void Motions::straight(Block& block, bool rapid, std::size_t place) {
  const Point end = end_of(block, place);
  if (!block.once(530) || !rules_.reference_is_zero) return go_straight(end, rapid, place);
  if (!rapid) refuse(block.g(GGroup::Once)->place, "G53 goes with G0; write that into its block");
  compensation_.left();
  mover_.reference(end, place);
}

Point Motions::start(std::size_t place) {
  return compensation_.on() || compensation_.leaving() ? compensation_.programmed() : mover_.start(place);
}

void Motions::go_straight(const Point& end, bool rapid, std::size_t place) {
  if (compensation_.on()) {
    const double length = legacy::length(legacy::difference(end, compensation_.programmed()));
    const double feed = rapid ? 0 : modes_.feed_over(length, place);
    return compensation_.move({rapid, std::nullopt, end, feed, mover_.line()}, place);
  }
  const Point& from = compensation_.programmed();
  if (rules_.radius_is_offset && compensation_.leaving() && end[0] == from[0] && end[1] == from[1])
    refuse(place, "write the move in X and Y that leaves the contour in the block of G40");
  compensation_.left();
  if (rapid) return mover_.rapid(end, place);
  mover_.line(end, place);
}

void Motions::go_along(const Arc& arc, double feed_mm_min, std::size_t place) {
  if (compensation_.leaving())
    refuse(place, "the first move behind G40 is a straight one, from beside the contour; write a line before this arc");
  if (compensation_.on()) return compensation_.move({false, arc, arc.end, feed_mm_min, mover_.line()}, place);
  mover_.arc(arc, feed_mm_min, place);
}

void Motions::go_to_written_end(const Point& end, double feed_mm_min, std::size_t place) {
  if (compensation_.on()) return compensation_.go_on_from(end);
  mover_.line(end, feed_mm_min, place);
}

void Motions::reference(Block& block, const Code& code) {
  require_unplaced(coordinates_, code.place);
  const bool first = code.number == 280;
  const auto& known = first ? options_.reference_mm : options_.second_reference_mm;
  if (!known) {
    refuse(code.place, fmt::format("where the machine keeps this point is not known here; give --{}reference-point "
                                   "X,Y,Z, or write the way there as G0",
                                   first ? "" : "second-"));
  }
  const Point there{reference_value(*known, 0, code.place), reference_value(*known, 1, code.place),
                    reference_value(*known, 2, code.place)};
  if (!block.has_any("XYZ")) return mover_.reference(there, code.place);
  const std::array<bool, 3> goes{block.has('X'), block.has('Y'), block.has('Z')};
  mover_.rapid(end_of(block, code.place), code.place);
  Point end = coordinates_.known_tip();
  for (std::size_t axis = 0; axis < end.size(); ++axis) {
    if (goes.at(axis)) end.at(axis) = there.at(axis);
  }
  mover_.reference(end, code.place);
}

Point Motions::written_centre(Block& block, const Point& start, std::size_t place) const {
  const Plane& plane = modes_.plane;
  const char first = kCentreLetters.at(plane.first), second = kCentreLetters.at(plane.second);
  if (!block.has(first) && !block.has(second)) {
    refuse(place, fmt::format("an arc without centre and radius; write {} and {}, or R", first, second));
  }
  if (modes_.absolute_centres && !(block.has(first) && block.has(second))) {
    refuse(place, fmt::format("under G90.1 an arc has both {} and {}", first, second));
  }
  Point centre = start;
  for (const std::size_t axis : {plane.first, plane.second}) {
    const Word* word = block.find(kCentreLetters.at(axis));
    if (word == nullptr) continue;
    centre.at(axis) =
        modes_.absolute_centres ? coordinates_.to_part(axis, modes_.mm(*word)) : start.at(axis) + modes_.mm(*word);
  }
  return centre;
}

void Motions::arc(Block& block, bool counter_clockwise, std::size_t place) {
  if (block.once(530)) refuse(place, "G53 goes with G0 and G1 only");
  const Plane& plane = modes_.plane;
  const Point start = this->start(place);
  const Point end = end_of(block, place);
  Arc arc{.end = end, .axis = legacy::unit_axis(plane.normal), .counter_clockwise = counter_clockwise};
  if (const Word* turns = rules_.arcs_have_turns ? block.find('P') : nullptr) arc.more_turns = turns_of(*turns) - 1;
  const char beside = kCentreLetters.at(plane.normal);  // which some posts write of every arc
  if (block.has(beside) && !modes_.absolute_centres && !block.has('R')) {
    const Word& none = block.use(beside);
    if (none.value != 0)
      refuse(none.place,
             fmt::format("{} in a plane that it is beside of: some controls take it for the pitch of a helix, "
                         "others for a fault; take it out",
                         beside));
  }
  if (const Word* radius = block.find('R')) {
    if (block.has_any("IJK")) refuse(radius->place, "an arc has a radius or a centre, not both");
    if (radius->value == 0) refuse(radius->place, "an arc of radius 0");
    arc.centre = centre_by_radius(start, end, plane, counter_clockwise, modes_.mm(*radius), radius->place);
    return go_along(arc, modes_.feed_over(length_of(start, arc, plane), place), place);
  }
  arc.centre = written_centre(block, start, place);
  const auto kept = arc_about(start, arc, plane, place);
  if (!kept && !compensation_.on()) return go_straight(end, false, place);
  const double feed = kept ? modes_.feed_over(length_of(start, *kept, plane), place) : 0;
  if (kept) go_along(*kept, feed, place);
  if (!kept || kept->end != end) go_to_written_end(end, feed, place);
}

}  // namespace rmac::gcode
