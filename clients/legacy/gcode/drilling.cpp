#include "clients/legacy/gcode/drilling.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clients/legacy/gcode/polar.hpp"
#include "clients/legacy/program/pecking.hpp"

namespace rmac::gcode {

namespace {

constexpr int kChipBreaking = 730, kFirst = 810, kDwelling = 820, kPecking = 830, kReaming = 850, kStopping = 860,
              kBoring = 890;

bool is_cycle(int code) {
  return code == kChipBreaking || (code >= kFirst && code <= kBoring);
}
bool pecks(int code) {
  return code == kChipBreaking || code == kPecking;
}
bool dwells(int code) {
  return code == kDwelling || code == kStopping || code == kBoring;
}

/// Of one block.
constexpr int kMostRepeats = legacy::kMostPecks;

/// Elsewhere K repeats.
void require_even_pecks(const Block& block) {
  for (const char letter : {'I', 'J', 'K'}) {
    if (!block.has(letter)) continue;
    refuse(block.place(letter),
           fmt::format("{} beside a hole: pecks that become less (I, J and K), and ways up to R between those of G73 "
                       "(K), are not taken; write Q alone, and write L where this is to say how often the hole is "
                       "repeated",
                       letter));
  }
}

int repeats_of(Block& block, const Rules::Cycles& rules) {
  const auto letter = std::ranges::find_if(rules.repeats, [&block](char one) { return block.has(one); });
  if (letter == rules.repeats.end()) return 1;
  const Word* word = block.find(*letter);
  const int least = rules.may_wait ? 0 : 1;
  if (word->value != std::round(word->value) || word->value < least || word->value > kMostRepeats) {
    refuse(word->place, fmt::format("{} is how often the hole is repeated, {} to {}", *letter, least, kMostRepeats));
  }
  return static_cast<int>(word->value);
}

}  // namespace

double Drilling::sticky(Block& block, char letter, std::optional<double>& value, std::size_t place) {
  if (const Word* word = block.find(letter))
    value = letter != 'P' ? modes_.mm(*word) : word->value * (word->whole ? whole_dwell_s_ : 1);
  if (!value) refuse(place, fmt::format("the first block of a canned cycle needs {}", letter));
  return *value;
}

void Drilling::read(Block& block, int code, std::size_t place) {
  static_cast<void>(sticky(block, 'R', retract_, place));
  static_cast<void>(sticky(block, kAxisLetters.at(modes_.plane.normal), depth_, place));
  const bool needs_dwell = rules_.dwell_is_free ? block.has('P') : dwells(code);
  if (needs_dwell && sticky(block, 'P', dwell_s_, place) < 0) refuse(place, "a dwell of less than no time");
  if (pecks(code) && !(sticky(block, 'Q', peck_, place) > 0)) refuse(place, "Q, the depth of a peck, is more than 0");
}

Drilling::Coordinated Drilling::coordinated() const {
  const std::size_t normal = modes_.plane.normal;
  legacy::Placement level;
  if (const auto& placement = coordinates_.placement()) {
    level.z = placement->turned(legacy::unit_axis(normal));
    level.shift.at(normal) = placement->shift.at(normal);
  } else {
    level.z = legacy::unit_axis(normal);
  }
  return {coordinates_.active(),
          normal,
          coordinates_.offset(coordinates_.active()),
          {coordinates_.to_part(0, 0), coordinates_.to_part(1, 0), coordinates_.to_part(2, 0)},
          level};
}

void Drilling::set_levels(Block& block) {
  const std::size_t normal = modes_.plane.normal;
  const bool writes_retract = block.has('R'), writes_depth = block.has(kAxisLetters.at(normal));
  const bool anew = !rules_.levels_stay;
  if (anew || writes_retract)
    retract_level_ = modes_.incremental ? initial_ + *retract_ : coordinates_.to_part(normal, *retract_);
  if (anew || writes_depth) {
    bottom_level_ = modes_.incremental ? retract_level_ + *depth_ : coordinates_.to_part(normal, *depth_);
    bottom_by_retract_ = modes_.incremental;
  } else if (writes_retract && bottom_by_retract_) {
    refuse(block.place('R'),
           fmt::format("{} was counted from the R before (G91); write it beside this R", kAxisLetters.at(normal)));
  }
}

void Drilling::drill(Block& block, int code, int before, std::size_t place) {
  const Plane& plane = modes_.plane;
  if (block.once(530)) refuse(place, "G53 goes with G0 and G1 only");
  if (code == kStopping && !switches_.spindle_turns()) {
    refuse(place, "G86 stops the spindle, which does not turn; write M3 or M4 and S before it");
  }
  if (!block.has_any("XYZ") && !mover_.turns()) refuse(place, "a canned cycle needs X, Y or Z in its block");
  if (!is_cycle(before)) begun_in_ = coordinated();
  if (rules_.levels_stay && begun_in_ != coordinated())
    refuse(place,
           "a work system, other coordinates or another plane in the midst of a cycle, whose levels were meant in "
           "those before; write G80 and a G0, and write the cycle again with R and Z");
  if (rules_.may_peck_less) require_even_pecks(block);
  Point at = mover_.start(place);
  if (before != code) dwell_s_ = std::nullopt;
  if (before != code && !(rules_.words_stay && is_cycle(before))) retract_ = depth_ = peck_ = std::nullopt;
  if (!is_cycle(before)) initial_ = at.at(plane.normal);
  read(block, code, place);
  set_levels(block);
  const double retract = retract_level_, bottom = bottom_level_;
  if (bottom > retract) refuse(place, "the hole's bottom is above R");
  if (rules_.cross_first && !modes_.retract_to_r && initial_ < retract)
    refuse(place, "under G98 R is not above the level where the cycles began: the tool would come back below it");
  if (!rules_.cross_first && at.at(plane.normal) < retract) {
    at.at(plane.normal) = retract;
    mover_.rapid(at, place);
  }
  const double clear = modes_.retract_to_r ? retract : std::max(initial_, retract);
  const int repeats = repeats_of(block, rules_);
  if (mover_.turns() && repeats != 1)
    refuse(place, "a table that turns beside a hole which is repeated is not taken; write each hole with its angle");
  if (pecks(code) && !((retract - bottom) / *peck_ * repeats <= kMostRepeats)) {
    refuse(place, fmt::format("more than {} pecks in one block", kMostRepeats));
  }
  const Word* first = block.find(kAxisLetters.at(plane.first));
  const Word* second = block.find(kAxisLetters.at(plane.second));
  for (const Word* word : {first, second}) {
    if (word == nullptr || repeats > 0) continue;
    const std::size_t axis = word == first ? plane.first : plane.second;
    if (written(*word, axis, at) != at.at(axis))
      refuse(word->place,
             "whether a tool that drills no hole goes there is not the same on all controls; write the way as G0");
  }
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const bool goes_round = repeat > 0 && modes_.incremental && block.is_polar();
    if (goes_round) go_round(block, at, place);
    for (const auto& [axis, word] : {std::pair{plane.first, first}, std::pair{plane.second, second}}) {
      if (word == nullptr || goes_round) continue;
      at.at(axis) = written(*word, axis, at);
    }
    mover_.rapid(at, place);
    Point above = at;
    above.at(plane.normal) = retract;
    mover_.rapid(above, place);
    hole(above, bottom, clear, code, place);
    at.at(plane.normal) = clear;
  }
}

double Drilling::written(const Word& word, std::size_t axis, const Point& at) const {
  const bool is_way = modes_.incremental || word.relative;
  return is_way ? at.at(axis) + modes_.mm(word) : coordinates_.to_part(axis, modes_.mm(word));
}

/// On by @ and ^ from the hole before: along a circle or a ray, or both.
void Drilling::go_round(const Block& block, Point& at, std::size_t place) const {
  const double unit = modes_.unit(place);
  const auto of_program = [&](std::size_t axis) { return (at.at(axis) - coordinates_.to_part(axis, 0)) / unit; };
  const PolarEnd end = polar_end(block, modes_, {of_program(0), of_program(1)});
  for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
    at.at(axis) = coordinates_.to_part(axis, end.at(axis) * unit);
}

void Drilling::peck(const Point& above, double bottom, int code, std::size_t place) {
  const std::size_t normal = modes_.plane.normal;
  const double retract = above.at(normal);
  // By number: a peck may be too small to change the depth that it is taken from.
  const int count = legacy::pecks_to(retract - bottom, *peck_);
  Point at = above;
  for (int number = 1; number < count; ++number) {
    const double depth = retract - number * *peck_;
    at.at(normal) = depth;
    mover_.line(at, place);
    if (code == kPecking) mover_.rapid(above, place);
    at.at(normal) = std::min(depth + legacy::kPeckBackOff_mm, retract);
    mover_.rapid(at, place);
  }
}

void Drilling::hole(const Point& above, double bottom, double clear, int code, std::size_t place) {
  const auto at = [&](double level) {
    Point point = above;
    point.at(modes_.plane.normal) = level;
    return point;
  };
  if (pecks(code)) peck(above, bottom, code, place);
  mover_.line(at(bottom), place);
  if (dwell_s_) writer_.dwell(*dwell_s_);
  if (code == kReaming || (code == kBoring && rules_.bore_to_r)) mover_.line(above, place);
  if (code == kBoring && !rules_.bore_to_r) mover_.line(at(clear), place);
  if (code == kStopping) switches_.hold_spindle();
  mover_.rapid(at(clear), place);
  if (code == kStopping) switches_.release_spindle();
}

}  // namespace rmac::gcode
