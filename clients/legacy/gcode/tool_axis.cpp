#include "clients/legacy/gcode/tool_axis.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/gcode/modes/offsets.hpp"
#include "clients/legacy/gcode/turns.hpp"

namespace rmac::gcode {

namespace {

constexpr std::array<char, 3> kRotaryLetters{'A', 'B', 'C'};
constexpr int kRapid = 0, kLine = 10;

std::size_t place_of(char letter) {
  return static_cast<std::size_t>(letter - 'A');
}

/// About X, Y or Z.
constexpr Plane plane_of(char letter) {
  return letter == 'A' ? Plane{1, 2, 0} : letter == 'B' ? Plane{2, 0, 1} : Plane{};
}

}  // namespace

void ToolAxis::read(Block& block) {
  const auto& code = block.g(GGroup::Motion);
  const int motion = code ? code->number : modes_.motion;
  read_angles(block, motion);
  const bool has_vector = block.has_any("IJK") && (motion == kRapid || motion == kLine);
  if (modes_.centre_point == ToolCentrePoint::Vectors && has_vector) read_vector(block, motion);
}

void ToolAxis::read_angles(Block& block, int motion) {
  std::optional<std::size_t> place;
  for (const char letter : kRotaryLetters) {
    if (!block.has(letter)) continue;
    const Word word = block.take(letter);
    if (!read_angle(letter, word)) continue;
    place = word.place;
    if (block.g(GGroup::Once))
      refuse(word.place,
             "what this axis does beside such a code, or where its reference point is, is not known here; write its "
             "angle into a block of its own");
  }
  if (!place) return;
  const Point axis = axis_of_angles(*place);
  if (axis == mover_.axis()) return;
  if (modes_.centre_point == ToolCentrePoint::Angles) return aim(block, axis, motion, *place);
  if (block.has_any("XYZ"))
    refuse(*place,
           "A, B and C beside X, Y and Z move the axes of another machine here; have the post write G43.4, under "
           "which X, Y and Z are those of the tip");
  mover_.aim(axis);
  coordinates_.forget_tip();
}

bool ToolAxis::read_angle(char letter, const Word& word) {
  const double degrees = modes_.degrees(word);
  if (std::ranges::find(options_.rotary, letter, &RotaryAxis::letter) == options_.rotary.end()) {
    if (degrees == 0) return false;
    refuse(word.place,
           fmt::format("which way axis {} turns the tool is not known here; give --rotary with the machine's "
                       "axes from the part to the tool, as --rotary C,A",
                       letter));
  }
  auto& angle = angles_.at(place_of(letter));
  if (modes_.incremental && !angle)
    refuse(word.place, fmt::format("where axis {} stands is not known here; write its angle under G90 first", letter));
  angle = degrees + (modes_.incremental ? *angle : 0);
  return true;
}

Point ToolAxis::axis_of_angles(std::size_t place) const {
  Point axis = legacy::unit_axis(2);
  for (auto rotary = options_.rotary.rbegin(); rotary != options_.rotary.rend(); ++rotary) {
    const auto& angle = angles_.at(place_of(rotary->letter));
    if (!angle)
      refuse(place, fmt::format("where axis {0} stands is not known here; write {0} beside this", rotary->letter));
    axis = turn_about_normal(plane_of(rotary->letter), rotary->sign * *angle).turned(axis);
  }
  return axis;
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
