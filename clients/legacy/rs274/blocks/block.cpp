#include "clients/legacy/rs274/blocks/block.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "clients/legacy/rs274/blocks/expression.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// How far a code's number may be from what it means, as in rs274.
constexpr double kNear = 1e-3;
constexpr std::string_view kAxesNotTaken = "ABCUVW";

std::string g_name(int tenfold) {
  return tenfold % 10 == 0 ? fmt::format("G{}", tenfold / 10) : fmt::format("G{}.{}", tenfold / 10, tenfold % 10);
}

/// The integer that a number is near to; none where there is none from 0 to `most`.
std::optional<int> near_integer(double value, int most) {
  const double nearest = std::round(value);
  if (!(std::abs(value - nearest) < kNear) || nearest < 0 || nearest > most) return std::nullopt;
  return static_cast<int>(nearest);
}

bool is_axis_setter(const Block& block) {
  return block.once(100) || block.once(920) || block.once(280) || block.once(300);
}

}  // namespace

void Block::read(const Line& line, Parameters& parameters) {
  g_.fill(std::nullopt);
  m_.fill(std::nullopt);
  words_ = used_ = 0;
  codes_ = 0;
  assignments_.clear();
  const std::string_view text = line.text();
  std::size_t at = 0;
  if (text.starts_with('/')) ++at;
  if (at < text.size() && text[at] == 'N') {
    const std::size_t place = at++;
    const double number = Expression(text, parameters).value(at);
    if (number < 0) refuse(place, "a line's number is not negative");
  }
  while (at < text.size()) read_word(text, at, parameters);
  check_together();
  for (const Assignment& assignment : assignments_) {
    std::visit([&](const auto& name) { parameters.set(name, assignment.value); }, assignment.name);
  }
}

void Block::read_word(std::string_view text, std::size_t& at, Parameters& parameters) {
  const std::size_t place = at;
  const char letter = text[at];
  if (letter == Line::kComment) {
    ++at;
    return;
  }
  if (letter == '#') return read_assignment(text, at, parameters);
  if (letter < 'A' || letter > 'Z') {
    const bool shows = letter > ' ' && letter < '\x7f';
    refuse(place,
           shows ? fmt::format("a word begins with a letter, not with {}", letter) : "a character that no program has");
  }
  ++at;
  if (letter == 'O') refuse(place, "an O word begins its line; nothing but N and / may stand before it");
  if (letter == 'N') refuse(place, "a line's number stands at its begin");
  const double value = Expression(text, parameters).value(at);
  if (letter == 'G') return add_g(value, place);
  if (letter == 'M') return add_m(value, place);
  if (has(letter)) refuse(place, fmt::format("two {} words in one block; write two blocks", letter));
  if (kAxesNotTaken.find(letter) != std::string_view::npos) {
    refuse(place, fmt::format("axis {} is not taken yet: programs of X, Y and Z are", letter));
  }
  words_ |= bit(letter);
  word_.at(static_cast<std::size_t>(letter - 'A')) = {value, place};
}

void Block::read_assignment(std::string_view text, std::size_t& at, Parameters& parameters) {
  const std::size_t place = at++;
  Expression expression(text, parameters);
  Assignment assignment{expression.parameter_name(at), 0};
  if (at >= text.size() || text[at] != '=') refuse(at, "= expected: a # at the begin of a word sets a parameter");
  ++at;
  assignment.value = expression.value(at);
  const int* number = std::get_if<int>(&assignment.name);
  if (number != nullptr && *number >= Parameters::kFirstOfControl) {
    refuse(place, fmt::format("#{} is the control's own; set offsets by G10 and G92", *number));
  }
  const auto* name = std::get_if<std::string_view>(&assignment.name);
  if (name != nullptr && Parameters::is_of_control(*name))
    refuse(place, "this is what the last sub gave back; return [a value] sets it");
  assignments_.push_back(assignment);
}

void Block::add_g(double value, std::size_t place) {
  constexpr int kEndOfCycle = 800;  // G80
  const auto tenfold = near_integer(value * 10, 999);
  const GCode* known = tenfold ? find_g(*tenfold) : nullptr;
  if (known == nullptr) refuse(place, fmt::format("there is no G{:g}", value));
  if (!known->refusal.empty()) refuse(place, fmt::format("{}: {}", g_name(*tenfold), known->refusal));
  auto& there = g_.at(static_cast<std::size_t>(known->group));
  // Headers of posts put G80 beside a motion, which ends a cycle too; LinuxCNC takes it.
  const auto is_move = [](int number) { return number >= 0 && number <= 30; };
  if (there && *tenfold == kEndOfCycle && is_move(there->number)) return;
  if (there && there->number == kEndOfCycle && is_move(*tenfold)) there.reset();
  if (there) {
    refuse(place,
           fmt::format("{} and {} are of one modal group; write two blocks", g_name(there->number), g_name(*tenfold)));
  }
  there = Code{*tenfold, place};
  ++codes_;
}

void Block::add_m(double value, std::size_t place) {
  const auto number = near_integer(value, 999);
  const MCode* known = number ? find_m(*number) : nullptr;
  if (known == nullptr)
    refuse(place, fmt::format("there is no M{:g} here; what a machine's own code does, write out", value));
  if (!known->refusal.empty()) refuse(place, fmt::format("M{}: {}", *number, known->refusal));
  auto& there = m_.at(static_cast<std::size_t>(known->group));
  if (there) refuse(place, fmt::format("M{} and M{} are of one modal group; write two blocks", there->number, *number));
  there = Code{*number, place};
  ++codes_;
}

void Block::check_together() const {
  const auto& motion = g(GGroup::Motion);
  if (motion && motion->number != 800 && is_axis_setter(*this)) {
    refuse(motion->place, fmt::format("{} and {} would both use the axis words; write two blocks",
                                      g_name(motion->number), g_name(g(GGroup::Once)->number)));
  }
  if (const auto& off = m(MGroup::CoolantOff); off && (m(MGroup::Mist) || m(MGroup::Flood))) {
    refuse(off->place, "coolant on and off in one block; write two blocks");
  }
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

}  // namespace rmac::rs274
