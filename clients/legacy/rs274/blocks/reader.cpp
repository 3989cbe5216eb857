#include "clients/legacy/rs274/blocks/reader.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "clients/legacy/gcode/blocks/comments.hpp"
#include "clients/legacy/gcode/values/expression.hpp"
#include "clients/legacy/rs274/blocks/codes.hpp"
#include "clients/legacy/rs274/blocks/grammar.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// How far a code's number may be from what it means, as in rs274.
constexpr double kNear = 1e-3;
constexpr std::string_view kAxesNotTaken = "UVW";

/// The integer that a number is near to; none where there is none from 0 to `most`.
std::optional<int> near_integer(double value, int most) {
  const double nearest = std::round(value);
  if (!(std::abs(value - nearest) < kNear) || nearest < 0 || nearest > most) return std::nullopt;
  return static_cast<int>(nearest);
}

void add_g(double value, std::size_t place, Block& block) {
  const auto tenfold = near_integer(value * 10, 999);
  if (tenfold && ends_nothing(*tenfold)) return;
  const gcode::GCode* known = tenfold ? find_g(*tenfold) : nullptr;
  if (known == nullptr) refuse(place, fmt::format("there is no G{:g}", value));
  block.add_g(*known, place);
}

}  // namespace

void BlockReader::add_m(double value, std::size_t place, Block& block) {
  const auto number = near_integer(value, 999);
  const gcode::MCode* known = number ? find_m(*number) : nullptr;
  if (number && passed_m_.contains(*number) && (known == nullptr || !known->refusal.empty())) {
    passes_over_ = true;
    return;
  }
  if (known == nullptr)
    refuse(place, fmt::format("M{0:g} is a code of the machine's own, and what it does is not known here; write that "
                              "out, or give --pass-over M{0:g} where nothing is to be done",
                              value));
  block.add_m(*known, place);
}

void BlockReader::read(const Line& line, Parameters& parameters, Block& block) {
  block.clear();
  assignments_.clear();
  passes_over_ = false;
  const std::string_view text = line.text();
  std::size_t at = 0;
  if (text.starts_with('/')) ++at;
  if (at < text.size() && text[at] == 'N') {
    const std::size_t place = at++;
    const double number = gcode::Expression(text, grammar(), parameters).value(at);
    if (number < 0) refuse(place, "a line's number is not negative");
  }
  while (at < text.size()) read_word(text, at, parameters, block);
  block.check_together();
  for (const char letter : {'P', 'Q'}) {
    if (passes_over_) static_cast<void>(block.find(letter));  // what LinuxCNC gives to such a code
  }
  for (const Assignment& assignment : assignments_) {
    std::visit([&](const auto& name) { parameters.set(name, assignment.value); }, assignment.name);
  }
  gcode::refuse_active_comments(line);
}

void BlockReader::read_word(std::string_view text, std::size_t& at, const Parameters& parameters, Block& block) {
  const std::size_t place = at;
  const char letter = text[at];
  if (letter == Line::kComment) {
    ++at;
    return;
  }
  if (letter == '#') return read_assignment(text, at, parameters);
  const bool is_polar = letter == '@' || letter == '^';
  if (!is_polar && (letter < 'A' || letter > 'Z')) {
    const bool shows = letter > ' ' && letter < '\x7f';
    refuse(place,
           shows ? fmt::format("a word begins with a letter, not with {}", letter) : "a character that no program has");
  }
  ++at;
  if (letter == 'O') refuse(place, "an O word begins its line; nothing but N and / may stand before it");
  if (letter == 'N') refuse(place, "a line's number stands at its begin");
  const double value = gcode::Expression(text, grammar(), parameters).value(at);
  if (letter == 'G') return add_g(value, place, block);
  if (letter == 'M') return add_m(value, place, block);
  if (letter == '@') return block.add_polar_radius({value, place});
  if (letter == '^') return block.add_polar_angle({value, place});
  if (!block.has(letter) && kAxesNotTaken.find(letter) != std::string_view::npos) {
    refuse(place, fmt::format("axis {} is not taken yet: programs of X, Y and Z are", letter));
  }
  block.add_word(letter, {value, place});
}

void BlockReader::read_assignment(std::string_view text, std::size_t& at, const Parameters& parameters) {
  const std::size_t place = at++;
  gcode::Expression expression(text, grammar(), parameters);
  Assignment assignment{expression.parameter_name(at), 0};
  if (at >= text.size() || text[at] != '=') refuse(at, "= expected: a # at the begin of a word sets a parameter");
  ++at;
  assignment.value = expression.value(at);
  const int* number = std::get_if<int>(&assignment.name);
  constexpr int kShowsDebug = 5599;
  if (number != nullptr && *number == kShowsDebug) return;  // whether (DEBUG, …) is shown, which it is not
  if (number != nullptr && *number >= Parameters::kFirstOfControl) {
    refuse(place, fmt::format("#{} is the control's own; set offsets by G10 and G92", *number));
  }
  const auto* name = std::get_if<std::string_view>(&assignment.name);
  if (name != nullptr && Parameters::is_of_return(*name))
    refuse(place, "this is what the last sub gave back; return [a value] sets it");
  if (name != nullptr && Parameters::is_of_control(*name))
    refuse(place, fmt::format("#<{}> is the control's own, which a program reads; give yours another name", *name));
  assignments_.push_back(assignment);
}

}  // namespace rmac::rs274
