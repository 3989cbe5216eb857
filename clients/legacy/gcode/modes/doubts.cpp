#include "clients/legacy/gcode/modes/doubts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

constexpr int kFirstArc = 20, kFirstCycle = 730;

}  // namespace

void Doubts::leave_open(std::string_view why) {
  why_ = why;
  doubtful_ = {true, true, false};
}

void Doubts::settle() {
  if (why_.empty()) return;
  doubtful_ = {};
  why_ = {};
}

void Doubts::require_none(std::size_t place) const {
  if (left_open(0) || left_open(1))
    refuse(place, fmt::format("{}; name X and Y, under G90, in a straight move or a hole before this", why_));
}

void Doubts::require_none_of(const Block& block) const {
  for (const char letter : {'X', 'Y'}) {
    if (block.has(letter)) require_none(block.place(letter));
  }
}

bool Doubts::stays_clear(Block& block, int code, const Rules::Cycles& cycles) const {
  if (code >= kFirstCycle) {
    return std::ranges::any_of(cycles.repeats,
                               [&block](char letter) { return block.has(letter) && block.use(letter).value == 0; });
  }
  if (code >= kFirstArc) return false;
  constexpr std::size_t kZ = 2;
  const Word* word = why_.empty() || block.once(530) ? nullptr : block.find('Z');
  const auto& tip = coordinates_.tip().at(kZ);
  if (word == nullptr || !tip) return true;
  const bool is_way = modes_.incremental || word->relative;
  return is_way ? modes_.mm(*word) >= 0 : coordinates_.to_part(kZ, modes_.mm(*word)) >= *tip;
}

void Doubts::require_whole(Block& block, int code, const Rules::Cycles& cycles, std::size_t place) {
  bool any = false, all = true, any_doubtful = false;
  for (std::size_t axis = 0; axis < doubtful_.size(); ++axis) {
    if (!doubtful_.at(axis)) continue;
    const bool written = block.has(kAxisLetters.at(axis));
    any_doubtful = true;
    any = any || written;
    all = all && written && !modes_.incremental;
  }
  if (!any_doubtful) return;
  const bool is_arc = code >= kFirstArc && code < kFirstCycle;
  if (!any && (why_.empty() ? !is_arc : stays_clear(block, code, cycles))) return;
  if (is_arc || !all) {
    require_none(place);
    refuse(place,
           "behind G68, G69, G51.1 and G50.1 a straight move stands first that names all axes which they turn, under "
           "G90; write it before this");
  }
  doubtful_ = {};
  why_ = {};
}

}  // namespace rmac::gcode
