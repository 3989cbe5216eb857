#include "clients/legacy/gcode/modes/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

constexpr int kFirstArc = 20, kFirstCycle = 730;
constexpr double kSamePlace_mm = 1e-7;
constexpr const char* kBehindTurns =
    "behind G68, G69, G51.1 and G50.1 a straight move stands first that names all axes which they turn, under "
    "G90; write it before this";

}  // namespace

void Doubts::leave_open(std::string_view why) {
  why_ = why;
  open_ = {true, true, false};
}

void Doubts::settle() {
  open_ = {};
}

void Doubts::settle(std::size_t axis) {
  open_.at(axis) = false;
}

void Doubts::require_none(std::size_t place) const {
  if (left_open(0) || left_open(1))
    refuse(place, fmt::format("{}; name X and Y, under G90, in a straight move or a hole before this", why_));
}

void Doubts::require_known(std::size_t place) const {
  require_none(place);
  if (turned_[0] || turned_[1]) refuse(place, kBehindTurns);
}

void Doubts::require_none_of(const Block& block) const {
  for (const char letter : {'X', 'Y'}) {
    if (block.has(letter)) require_none(block.place(letter));
  }
}

bool Doubts::leads_up(Block& block) const {
  constexpr std::size_t kZ = 2;
  const Word* word = block.find('Z');
  const auto& tip = coordinates_.tip().at(kZ);
  if (word == nullptr || !tip) return true;
  const bool is_way = modes_.incremental || word->relative;
  return is_way ? modes_.mm(*word) >= 0 : coordinates_.to_part(kZ, modes_.mm(*word)) >= *tip - kSamePlace_mm;
}

bool Doubts::stays_clear(Block& block, int code, const Rules::Cycles& cycles) const {
  if (code >= kFirstCycle) {
    return std::ranges::any_of(cycles.repeats,
                               [&block](char letter) { return block.has(letter) && block.use(letter).value == 0; });
  }
  return code < kFirstArc && leads_up(block);
}

void Doubts::require_whole(Block& block, int code, const Rules::Cycles& cycles, std::size_t place) {
  const bool is_arc = code >= kFirstArc && code < kFirstCycle, is_open = open_[0] || open_[1];
  bool any = is_open && block.has_any("XY"), all = true, any_doubtful = is_open;
  for (std::size_t axis = 0; axis < turned_.size(); ++axis) {
    if (!turned_.at(axis) && !open_.at(axis)) continue;
    const bool written = block.has(kAxisLetters.at(axis));
    any_doubtful = true;
    any = any || written;
    all = all && written && !modes_.incremental;
  }
  if (!any_doubtful) return;
  if (is_open && block.once(530)) {
    for (std::size_t axis = 0; axis < open_.size(); ++axis) {
      if (block.has(kAxisLetters.at(axis))) settle(axis);
    }
    return;
  }
  if (!any && (is_open ? stays_clear(block, code, cycles) : !is_arc)) return;
  if (is_arc || !all) {
    require_none(place);
    refuse(place, kBehindTurns);
  }
  turned_ = {};
  settle();
}

void Doubts::reach_reference(Block& block) {
  if (!(open_[0] || open_[1])) return;
  if (!leads_up(block)) require_none(block.place('Z'));
  const bool all = !block.has_any("XYZ");
  for (std::size_t axis = 0; axis < open_.size(); ++axis) {
    if (all || block.has(kAxisLetters.at(axis))) settle(axis);
  }
}

}  // namespace rmac::gcode
