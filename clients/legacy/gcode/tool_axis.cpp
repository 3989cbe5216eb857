#include "clients/legacy/gcode/tool_axis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "clients/legacy/gcode/modes/offsets.hpp"
#include "clients/legacy/gcode/modes/turns.hpp"

namespace rmac::gcode {

namespace {

constexpr std::array<char, 3> kRotaryLetters{'A', 'B', 'C'};
constexpr int kRapid = 0, kLine = 10, kReference = 280;

}  // namespace

void ToolAxis::read(Block& block) {
  const auto& code = block.g(GGroup::Motion);
  const bool goes_on = code && code->number == Modes::kNoMotion && rules_.motion_outlives_cycles;
  const int motion = goes_on ? modes_.interpolation : code ? code->number : modes_.motion;
  if (block.once(kReference)) leave_for_reference(block);
  read_angles(block, motion);
  const bool has_vector = block.has_any("IJK") && (motion == kRapid || motion == kLine);
  if (modes_.centre_point == ToolCentrePoint::Vectors && has_vector) read_vector(block, motion);
}

void ToolAxis::read_angles(Block& block, int motion) {
  const KnownAngles before = angles_;
  std::optional<std::size_t> place;
  for (const char letter : kRotaryLetters) {
    if (!block.has(letter)) continue;
    const Word word = block.take(letter);
    if (block.once(kReference) && rotary(letter) != nullptr) continue;
    if (!read_angle(letter, word)) continue;
    place = word.place;
    if (block.g(GGroup::Once))
      refuse(word.place,
             "what this axis does beside such a code, or where its reference point is, is not known here; write its "
             "angle into a block of its own");
  }
  if (place) turn(block, before, motion, *place);
}

void ToolAxis::turn(Block& block, const KnownAngles& before, int motion, std::size_t place) {
  const legacy::Placement turn = turn_of_angles(place), turn_before = std::exchange(turn_, turn);
  const bool seen = !std::exchange(at_reference_, std::nullopt) && mover_.axis() == turn_before.z;
  const Point& axis = turn.z;
  const bool by_part = modes_.centre_point == ToolCentrePoint::Angles;
  const bool is_table = turntable_.carries(before) && turntable_.carries(angles_);
  if (is_table && turntable_.in_force()) {
    const TableAngles end = zeros_for_unknown(angles_);
    const auto begin = seen ? std::optional(zeros_for_unknown(before)) : std::nullopt;
    if (begin != end) turntable_.turn(begin, end, motion, place);
    return;
  }
  if (!seen && coordinates_.table()) {
    coordinates_.turn(std::nullopt);
    coordinates_.forget_tip();
  }
  if (turn_before == turn && axis == mover_.axis()) return;
  if (modes_.centre_point == ToolCentrePoint::Vectors)
    refuse(place,
           "under G43.5 I, J and K say which way the tool points; write A, B and C behind G49, or G43.4 in its place");
  if (by_part) return aim(block, axis, motion, place);
  if (block.has_any("XYZ"))
    refuse(place,
           "A, B and C beside X, Y and Z move the axes of another machine here; where they turn a table, give "
           "--rotary-centre; else have the post write G43.4, under which X, Y and Z are those of the tip");
  coordinates_.forget_tip();
  if (is_table) return mover_.turn_unseen(axis);
  mover_.aim(axis);
}

/// G28 and these axes: they go to where nobody here knows, and X, Y and Z mean nothing until they are somewhere else.
void ToolAxis::leave_for_reference(const Block& block) {
  const bool all = !block.has_any("XYZABC");
  for (const auto& rotary : options_.rotary) {
    if (!all && !block.has(rotary.letter)) continue;
    angles_.at(index_of(rotary.letter)) = std::nullopt;
    at_reference_ = rotary.letter;
  }
}

void ToolAxis::require_none_at_reference(std::size_t place) const {
  if (!at_reference_) return;
  refuse(place,
         fmt::format("where axis {0} stands behind G28 is not known here; write {0} before this move", *at_reference_));
}

void ToolAxis::require_coordinates_of_part(std::size_t place) const {
  if (modes_.centre_point == ToolCentrePoint::Vectors) return;
  require_none_at_reference(place);
  if (modes_.centre_point == ToolCentrePoint::Angles || turning_.tilted()) return;
  if (turn_ == legacy::Placement{} && mover_.axis() == legacy::unit_axis(2)) return;
  if (turntable_.carries(angles_) && (mover_.turns() || mover_.axis() == turn_.z)) return;
  refuse_coordinates(place);
}

/// Axes that turn the tool leave those of the machine as they lie to the part, and a table turns them with the part. A
/// tilted plane and vectors say how the tool points, but not where the axes stand then.
void ToolAxis::require_axes_of_machine(const Block& block, std::size_t place) const {
  constexpr double kSame = 1e-4;  // of angles that posts round to 0.001 degree
  const bool is_turned = legacy::length(legacy::difference(mover_.axis(), legacy::unit_axis(2))) > kSame;
  if (is_turned && options_.rotary.empty())
    refuse(place,
           "the tool is turned, and whether that turned the machine's axes away from the part is not known here; give "
           "--rotary C,A with the axes that turn the tool, and --rotary-centre where they turn a table");
  const bool has_table =
      std::ranges::any_of(options_.rotary, [](const auto& axis) { return axis.centre_mm.has_value(); });
  if (has_table) require_none_at_reference(place);
  if (!has_table || !turntable_.carries(angles_)) {
    const bool beside_z = block.has_any("XY") || !block.has('Z');
    const auto moves_axes = [this, beside_z](const RotaryAxis& axis) {
      return axis.centre_mm.has_value() && !is_upright(axis, angles_) && (axis.letter != 'C' || beside_z);
    };
    if (std::ranges::none_of(options_.rotary, moves_axes)) return;
    refuse(place,
           "a table is turned below a tilted tool, and how the machine's axes lie to the part then is not taken; turn "
           "the table back before this, or write the way as G0 under G43.4");
  }
  if (legacy::length(legacy::difference(mover_.axis(), turn_.z)) <= kSame) return;
  refuse(
      place,
      "the tool does not point as the table's angles have it, so how the machine's axes lie to the part is not known "
      "here; write A, B and C before G68.2, as G53.1 turns them, and see whether --rotary has their sense");
}

void ToolAxis::refuse_coordinates(std::size_t place) {
  refuse(
      place,
      "the tool, or the part, is turned, and X, Y and Z are those of the machine: where on the part this is, is not "
      "known here; give --rotary-centre, where A, B and C turn a table, or have the post write G68.2 or G43.4 before "
      "it, or turn back by A, B and C, which --rotary gives a meaning");
}

bool ToolAxis::read_angle(char letter, const Word& word) {
  const double degrees = modes_.degrees(word);
  const RotaryAxis* axis = rotary(letter);
  if (axis == nullptr) {
    if (degrees == 0) return false;
    refuse(word.place,
           fmt::format("which way axis {} turns the tool is not known here; give --rotary with the machine's "
                       "axes from the part to the tool, as --rotary C,A",
                       letter));
  }
  auto& angle = angles_.at(index_of(letter));
  if (modes_.incremental && !angle)
    refuse(word.place, fmt::format("where axis {} stands is not known here; write its angle under G90 first", letter));
  const bool comes_from_zero = !angle && !at_reference_;
  if (modes_.incremental) {
    *angle += degrees;
  } else if (angle || comes_from_zero) {
    angle = turntable_.led(*axis, angle.value_or(0), word, degrees);
  } else {
    angle = degrees;
  }
  return true;
}

legacy::Placement ToolAxis::turn_of_angles(std::size_t place) const {
  legacy::Placement turn;
  for (auto rotary = options_.rotary.rbegin(); rotary != options_.rotary.rend(); ++rotary) {
    const auto& angle = angles_.at(index_of(rotary->letter));
    if (!angle)
      refuse(place, fmt::format("where axis {0} stands is not known here; write {0} beside this", rotary->letter));
    turn = turn_about_normal(plane_of(rotary->letter), rotary->sign * *angle).after(turn);
  }
  return turn;
}

void ToolAxis::read_vector(Block& block, int motion) {
  Point vector{};
  std::size_t place = 0;
  for (std::size_t axis = 0; axis < vector.size(); ++axis) {
    const char letter = kCentreLetters.at(axis);
    if (!block.has(letter)) continue;
    const Word word = block.take(letter);
    vector.at(axis) = modes_.number(word);
    place = word.place;
  }
  constexpr double kShortest = 1e-6;
  const double length = legacy::length(vector);
  if (!(length > kShortest)) refuse(place, "I, J and K of a tool axis have no direction");
  const auto& placement = coordinates_.placement();
  const Point there = placement ? placement->turned(vector) : vector;
  aim(block, legacy::scaled(1 / length, there), motion, place);
}

void ToolAxis::aim(const Block& block, const Point& axis, int motion, std::size_t place) {
  if (axis == mover_.axis()) return;
  if (coordinates_.placement() && modes_.centre_point == ToolCentrePoint::Angles) require_unplaced(coordinates_, place);
  if (block.has_any("XYZ")) return mover_.aim(axis);
  if (motion == kRapid) return mover_.turn(axis, place);
  if (motion != kLine) refuse(place, "what turns the tool is a G0 or G1; write that into this block");
  const Point here = mover_.start(place);
  mover_.aim(axis);
  mover_.line(here, place);
}

}  // namespace rmac::gcode
