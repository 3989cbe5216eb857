#include "clients/legacy/fanuc/haas/cycle.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/blocks/words.hpp"
#include "clients/legacy/gcode/compensation_words.hpp"

namespace rmac::fanuc::haas {

namespace {

constexpr int kRapid = 0, kLine = 10, kClockwise = 20, kCounterClockwise = 30, kFirstCycle = 730;
constexpr int kPocketClockwise = 120, kPocketCounterClockwise = 130, kHolesOfCircle = 700;
/// Circles or holes of one block.
constexpr int kMost = 10'000;
constexpr double kSame_mm = 1e-9;

gcode::Block motion(int tenfold, std::size_t place) {
  gcode::Block block;
  block.add_g({tenfold, gcode::GGroup::Motion, {}}, place);
  return block;
}

}  // namespace

Cycle::Cycle(const gcode::Code& code, gcode::Block& block, const gcode::Interpreter& interpreter)
    : code_(code), motion_before_(interpreter.modes().motion) {
  gcode::require_nothing_behind(block, "a cycle");
  if (const auto& once = block.g(gcode::GGroup::Once))
    refuse(once->place,
           fmt::format("{} beside {}; write two blocks", gcode::g_name(once->number), gcode::g_name(code.number)));
  const std::string_view own = is_pocket() ? "IKLQZ" : "IJKLXY";
  for (const char letter : own) {
    if (block.has(letter)) words_.emplace(letter, block.take(letter));
  }
  const auto& beside = block.g(gcode::GGroup::Motion);
  if (is_pocket() && beside && beside->number != kRapid && beside->number != kLine &&
      beside->number != gcode::Modes::kNoMotion)
    refuse(beside->place, fmt::format("{} beside a pocket; write two blocks", gcode::g_name(beside->number)));
  if (!is_pocket()) {
    take_holes(block);
    return;
  }
  const bool ended = beside && beside->number == gcode::Modes::kNoMotion;
  if (ended) motion_before_ = gcode::Modes::kNoMotion;
  const int acts = ended ? interpreter.modes().interpolation : beside ? beside->number : motion_before_;
  if ((acts == kClockwise || acts == kCounterClockwise) && (block.has_any("XY") || block.is_polar()))
    refuse(code.place, fmt::format("{} behind {}, which X and Y beside it would be an arc of; write G0 or G1 beside it",
                                   gcode::g_name(code.number), gcode::g_name(acts)));
}

void Cycle::take_holes(gcode::Block& block) const {
  const std::string name = gcode::g_name(code_.number);
  for (const char letter : {'A', 'B', 'C'}) {
    if (block.has(letter)) refuse(block.place(letter), fmt::format("{} beside {}; write two blocks", letter, name));
  }
  if (block.is_polar())
    refuse((block.polar_radius() ? block.polar_radius() : block.polar_angle())->place,
           fmt::format("X and Y under G16 beside {}; write G15 before, and X and Y of the circle's middle", name));
  const auto& beside = block.g(gcode::GGroup::Motion);
  const int motion = beside ? beside->number : motion_before_;
  const bool drills = motion >= kFirstCycle && motion != gcode::Modes::kNoMotion;
  if (drills && (beside || block.has('Z'))) block.add_word('L', {0, code_.place});
}

bool Cycle::is_pocket() const noexcept {
  return code_.number == kPocketClockwise || code_.number == kPocketCounterClockwise;
}

const gcode::Word* Cycle::find(char letter) const {
  const auto found = words_.find(letter);
  return found == words_.end() ? nullptr : &found->second;
}

const gcode::Word& Cycle::word(char letter) const {
  if (const gcode::Word* found = find(letter)) return *found;
  const bool is_depth = letter == 'Z';
  refuse(code_.place, fmt::format("{} needs {}{}", gcode::g_name(code_.number), letter, is_depth ? ", its depth" : ""));
}

int Cycle::count(char letter, int least) const {
  return integer_of(word(letter), least, kMost, fmt::format("{} says how many", letter));
}

std::vector<gcode::Block> Cycle::written_out(const gcode::Options& options,
                                             const gcode::Interpreter& interpreter) const {
  interpreter.require_no_contour(code_.place);
  const auto& tip = interpreter.coordinates().tip();
  if (!tip[0] || !tip[1])
    refuse(code_.place,
           "around the place where the tool is: that is not known here; write a G0 to X, Y and Z before it");
  if (is_pocket() || !(find('X') != nullptr && find('Y') != nullptr && !interpreter.modes().incremental))
    interpreter.doubts().require_known(code_.place);
  if (interpreter.modes().plane.normal != 2) refuse(code_.place, "this cycle is taken in G17");
  return is_pocket() ? pocket(options, interpreter) : holes(interpreter);
}

std::vector<double> Cycle::radii_mm(const gcode::Modes& modes, double tool_mm) const {
  const double first = modes.mm(word('I'));
  const double last = find('K') != nullptr ? modes.mm(word('K')) : first;
  if (!(first > tool_mm))
    refuse(word('I').place, "I, the radius of the first circle, is more than that of the tool (D)");
  if (find('K') == nullptr && find('Q') != nullptr)
    refuse(find('Q')->place, "Q, by how much each circle is greater, goes with K, the radius of the last one");
  std::vector<double> radii{first - tool_mm};
  if (find('K') == nullptr) return radii;
  if (!(last > first)) refuse(word('K').place, "K, the radius of the last circle, is more than I, that of the first");
  const double step = modes.mm(word('Q'));
  if (!(step > 0)) refuse(word('Q').place, "Q, by how much each circle is greater, is more than 0");
  const double steps = std::ceil((last - first) / step - kSame_mm);
  if (!(steps <= kMost)) refuse(word('Q').place, fmt::format("more than {} circles", kMost));
  for (int number = 1; number < static_cast<int>(steps); ++number) radii.push_back(first + number * step - tool_mm);
  radii.push_back(last - tool_mm);
  return radii;
}

/// Half a turn leads to each circle, and back to the middle: tangent, so that nothing stops there.
void Cycle::add_circles(const std::vector<double>& radii, const Lengths& lengths,
                        std::vector<gcode::Block>& blocks) const {
  const int turn = code_.number == kPocketClockwise ? kClockwise : kCounterClockwise;
  double x = 0, side = 1;
  const auto go_to = [&](double to) {
    gcode::Block half = motion(turn, code_.place);
    half.add_word('X', lengths.way(to - x));
    half.add_word('I', lengths.way((to - x) / 2));
    blocks.push_back(half);
    x = to;
  };
  for (const double radius : radii) {
    go_to(side * radius);
    gcode::Block circle = motion(turn, code_.place);
    circle.add_word('I', lengths.way(-x));
    blocks.push_back(circle);
    side = -side;
  }
  go_to(0);
}

std::vector<gcode::Block> Cycle::pocket(const gcode::Options& options, const gcode::Interpreter& interpreter) const {
  const gcode::Modes& modes = interpreter.modes();
  if (motion_before_ >= kFirstCycle && motion_before_ != gcode::Modes::kNoMotion)
    refuse(code_.place, "a pocket while a canned cycle is in force; write G80 before it");
  const int levels = find('L') != nullptr ? count('L', 1) : 1;
  if (levels > 1 && !modes.incremental)
    refuse(word('L').place, "L goes down by Z again and again, which is a way then; write G91 beside it");
  const double tool_mm = gcode::diameter_in_register(code_.place, options, modes) / 2;
  const std::vector<double> radii = radii_mm(modes, tool_mm);
  if (radii.size() * static_cast<std::size_t>(levels) > kMost)
    refuse(code_.place, fmt::format("more than {} circles", kMost));
  std::vector<gcode::Block> blocks;
  for (int level = 0; level < levels; ++level) {
    blocks.push_back(motion(kLine, code_.place));
    blocks.back().add_word('Z', word('Z'));
    add_circles(radii, {modes, code_.place}, blocks);
  }
  blocks.push_back(motion(modes.motion == kRapid ? kRapid : kLine, code_.place));
  return blocks;
}

std::vector<gcode::Block> Cycle::holes(const gcode::Interpreter& interpreter) const {
  const gcode::Modes& modes = interpreter.modes();
  if (modes.motion < kFirstCycle || modes.motion == gcode::Modes::kNoMotion)
    refuse(code_.place,
           fmt::format("{} says where holes are, and no cycle how they are drilled; write one before it, as "
                       "G81 R Z F L0",
                       gcode::g_name(code_.number)));
  const bool is_circle = code_.number == kHolesOfCircle;
  if (is_circle && find('K') != nullptr) refuse(find('K')->place, "K belongs to G71; the holes of G70 are even");
  const int holes = count('L', 1);
  const double radius = modes.mm(word('I'));
  const double first = is_circle && find('J') == nullptr ? 0 : modes.degrees(word('J'));
  const double step = is_circle ? 360.0 / holes : modes.degrees(word('K'));
  if (!(radius > 0)) refuse(word('I').place, "I, the radius of the circle, is more than 0");
  const Lengths lengths{modes, code_.place};
  std::array<double, 2> here{}, centre{};
  for (std::size_t axis = 0; axis < here.size(); ++axis) {
    here.at(axis) = interpreter.coordinates().program_tip(axis).value();
    const gcode::Word* written = find(gcode::kAxisLetters.at(axis));
    centre.at(axis) = here.at(axis);
    if (written != nullptr) centre.at(axis) = modes.mm(*written) + (modes.incremental ? here.at(axis) : 0);
  }
  std::vector<gcode::Block> blocks;
  for (int number = 0; number < holes; ++number) {
    constexpr double kDegree = std::numbers::pi / 180;
    const double angle = (first + number * step) * kDegree;
    const std::array<double, 2> hole{centre[0] + radius * std::cos(angle), centre[1] + radius * std::sin(angle)};
    gcode::Block block;
    block.add_word('X', lengths.way(hole[0] - here[0]));
    block.add_word('Y', lengths.way(hole[1] - here[1]));
    blocks.push_back(block);
    here = hole;
  }
  return blocks;
}

}  // namespace rmac::fanuc::haas
