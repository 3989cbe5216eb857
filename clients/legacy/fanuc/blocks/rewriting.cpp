#include "clients/legacy/fanuc/blocks/rewriting.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <utility>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc {

void rewrite_dwell(gcode::Block& block, const gcode::Modes& modes) {
  if (!block.once(40)) return;
  for (const char letter : {'X', 'U'}) {
    if (!block.has(letter)) continue;
    const gcode::Word word = block.take(letter);
    if (block.has('P')) refuse(word.place, "a dwell has one time; take this or P out");
    block.add_word('P', {modes.number(word), word.place});
  }
}

void rewrite_reference(gcode::Block& block, bool all_alone) {
  if (!block.once(280) && !block.once(300)) return;
  for (const auto& [way, axis] : {std::pair{'U', 'X'}, std::pair{'V', 'Y'}, std::pair{'W', 'Z'}}) {
    if (!block.has(way)) continue;
    gcode::Word word = block.take(way);
    word.relative = true;
    block.add_word(axis, word);
  }
  const std::size_t place = block.g(gcode::GGroup::Once)->place;
  if (!block.has_any("XYZABC") && !(all_alone && block.once(280)))
    refuse(place, "this needs X, Y or Z: the axes that go to the reference point");
  if (const gcode::Word* point = block.once(300) ? block.find('P') : nullptr; point != nullptr && point->value != 2)
    refuse(point->place, "of G30 there is the second reference point, P2; write the way to others as G0");
}

void rewrite_polar(gcode::Block& block, const gcode::Modes& modes) {
  constexpr int kPlaneOfXY = 170, kIncremental = 910, kZ = 2;
  if (!block.has_any("XY") || block.g(gcode::GGroup::Once)) return;
  const auto& plane = block.g(gcode::GGroup::Plane);
  const bool in_plane = plane ? plane->number == kPlaneOfXY : modes.plane.normal == kZ;
  const auto& distance = block.g(gcode::GGroup::Distance);
  const bool incremental = distance ? distance->number == kIncremental : modes.incremental;
  if (!in_plane)
    refuse(block.place(block.has('X') ? 'X' : 'Y'),
           "G16 is taken in the plane of X and Y; write G17 before this, or G15");
  if (block.has('X')) {
    gcode::Word radius = block.take('X');
    if (incremental)
      refuse(radius.place,
             "X under G16 and G91 counts from where the tool is, on some controls; write G90 before this");
    radius = {modes.mm(radius) / modes.unit(radius.place), radius.place};
    block.add_polar_radius(radius);
  }
  if (block.has('Y')) {
    const gcode::Word angle = block.take('Y');
    block.add_polar_angle({modes.degrees(angle), angle.place});
  }
}

void pass_over_look_ahead(gcode::Block& block, const gcode::Code& code) {
  const auto pass = [&block](char letter, double least, double most, std::string_view message) {
    if (!block.has(letter)) return;
    const gcode::Word word = block.take(letter);
    if (!(word.value >= least && word.value <= most)) refuse(word.place, std::string(message));
  };
  constexpr double kAny = 1e9;
  switch (code.number) {
    case 50:
      if (!block.has('P')) refuse(code.place, "G5 needs P, as in G5 P10000");
      return pass('P', 0, 10000, "P of G5 is 0 to 10000");
    case 51:
      if (!block.has('Q')) refuse(code.place, "G5.1 needs Q, as in G5.1 Q1");
      pass('Q', 0, 3, "of G5.1 there are Q0 to Q3");
      pass('R', 0, 10, "R of G5.1 is a level, 1 to 10");
      for (const char axis : gcode::kAxisLetters) pass(axis, 0, 0, "X, Y and Z of G5.1 are 0: the axes that it is for");
      return;
    case 80:
      if (!block.has('P')) refuse(code.place, "G8 needs P, as in G8 P1");
      return pass('P', 0, 1, "P of G8 is 1 or 0");
    case 1030:
      return pass('P', 0, kAny, "P of G103 is a number of blocks");
    default:
      pass('P', 1, 3, "P of G187 is a level, 1 to 3");
      return pass('E', 0, kAny, "E of G187 is a length");
  }
}

}  // namespace rmac::fanuc
