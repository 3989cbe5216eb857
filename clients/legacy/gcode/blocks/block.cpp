#include "clients/legacy/gcode/blocks/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

std::string g_name(int tenfold) {
  return tenfold % 10 == 0 ? fmt::format("G{}", tenfold / 10) : fmt::format("G{}.{}", tenfold / 10, tenfold % 10);
}

void Block::clear() noexcept {
  g_.fill(std::nullopt);
  m_.fill(std::nullopt);
  words_ = used_ = 0;
  polar_radius_ = polar_angle_ = std::nullopt;
  codes_ = 0;
}

void Block::add_word(char letter, const Word& word) {
  if (has(letter)) refuse(word.place, fmt::format("two {} words in one block; write two blocks", letter));
  words_ |= bit(letter);
  word_.at(static_cast<std::size_t>(letter - 'A')) = word;
}

void Block::add_polar_radius(const Word& word) {
  if (std::exchange(polar_radius_, word)) refuse(word.place, "two @ words in one block; write two blocks");
}

void Block::add_polar_angle(const Word& word) {
  if (std::exchange(polar_angle_, word)) refuse(word.place, "two ^ words in one block; write two blocks");
}

Word Block::take(char letter) noexcept {
  words_ &= ~bit(letter);
  return word_.at(static_cast<std::size_t>(letter - 'A'));
}

void Block::add_g(const GCode& code, std::size_t place) {
  constexpr int kEndOfCycle = 800;  // G80
  if (!code.refusal.empty()) refuse(place, fmt::format("{}: {}", g_name(code.tenfold), code.refusal));
  auto& there = g_.at(static_cast<std::size_t>(code.group));
  // Headers of posts put G80 beside a motion, which ends a cycle too; LinuxCNC takes it.
  const auto is_move = [](int number) { return number >= 0 && number <= 30; };
  if (there && code.tenfold == kEndOfCycle && is_move(there->number)) return;
  if (there && there->number == kEndOfCycle && is_move(code.tenfold)) there.reset();
  if (there) {
    refuse(place, fmt::format("{} and {} are of one modal group; write two blocks", g_name(there->number),
                              g_name(code.tenfold)));
  }
  there = Code{code.tenfold, place};
  ++codes_;
}

void Block::add_m(const MCode& code, std::size_t place) {
  if (!code.refusal.empty()) refuse(place, fmt::format("M{}: {}", code.number, code.refusal));
  auto& there = m_.at(static_cast<std::size_t>(code.group));
  if (there)
    refuse(place, fmt::format("M{} and M{} are of one modal group; write two blocks", there->number, code.number));
  there = Code{code.number, place};
  ++codes_;
}

void Block::check_together() const {
  const auto& motion = g(GGroup::Motion);
  if (motion && motion->number != 800 && axes_are_taken()) {
    refuse(motion->place, fmt::format("{} and {} would both use the axis words; write two blocks",
                                      g_name(motion->number), g_name(g(GGroup::Once)->number)));
  }
  if (const auto& off = m(MGroup::CoolantOff); off && (m(MGroup::Mist) || m(MGroup::Flood))) {
    refuse(off->place, "coolant on and off in one block; write two blocks");
  }
}

bool Block::axes_are_taken() const {
  constexpr std::array kTaking{100, 280, 300, 520, 920};
  return std::ranges::any_of(kTaking, [this](int tenfold) { return once(tenfold); });
}

bool Block::has_any(std::string_view letters) const noexcept {
  for (const char letter : letters) {
    if (has(letter)) return true;
  }
  return false;
}

bool Block::does_more_than_move() const noexcept {
  for (std::size_t group = 0; group < g_.size(); ++group) {
    if (g_.at(group) && static_cast<GGroup>(group) != GGroup::Motion) return true;
  }
  return std::ranges::any_of(m_, [](const auto& code) { return code.has_value(); });
}

const Word& Block::use(char letter) {
  used_ |= bit(letter);
  return word_.at(static_cast<std::size_t>(letter - 'A'));
}

void Block::require_all_used() const {
  const std::uint32_t left = words_ & ~used_;
  if (left == 0) return;
  const auto letter = static_cast<char>('A' + std::countr_zero(left));
  refuse(word_.at(static_cast<std::size_t>(letter - 'A')).place,
         fmt::format("nothing in this block uses {}; take it out, or write the code that it belongs to", letter));
}

}  // namespace rmac::gcode
