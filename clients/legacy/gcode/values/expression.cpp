#include "clients/legacy/gcode/values/expression.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <utility>

#include "clients/legacy/program/refusal.hpp"

namespace rmac::gcode {

using legacy::refuse;

namespace {

/// Values within values: what nests deeper is no program, and would use up the stack.
constexpr int kDeepest = 100;
/// How far a parameter's number may be from an integer, as in rs274.
constexpr double kInteger = 1e-4;

double finite(double value, std::size_t place) {
  if (!std::isfinite(value)) refuse(place, "the value is too large for a number");
  return value;
}

bool is_digit(char letter) noexcept {
  return letter >= '0' && letter <= '9';
}

template <typename Entry>
const Entry* find_word(std::span<const Entry> table, std::string_view text, std::size_t at) noexcept {
  if (at >= text.size()) return nullptr;
  for (const Entry& entry : table) {
    if (text.substr(at).starts_with(entry.word)) return &entry;
  }
  return nullptr;
}

}  // namespace

bool Expression::skip(std::string_view word, std::size_t& at) const noexcept {
  if (at > text_.size() || !text_.substr(at).starts_with(word)) return false;
  at += word.size();
  return true;
}

void Expression::expect(char letter, std::size_t& at) const {
  if (!skip({&letter, 1}, at)) refuse(at, fmt::format("{} expected", letter));
}

Maybe Expression::maybe(std::size_t& at) {
  if (++depth_ > kDeepest) refuse(at, fmt::format("values nested more than {} deep", kDeepest));
  Maybe result;
  const char letter = at < text_.size() ? text_[at] : '\0';
  const char next = at + 1 < text_.size() ? text_[at + 1] : '\0';
  if (letter == '[') {
    result = bracketed(at);
  } else if (letter == '#') {
    result = parameter(at);
  } else if ((letter == '-' || letter == '+') && (next == '[' || next == '#' || (next >= 'A' && next <= 'Z'))) {
    ++at;
    result = maybe(at);
    if (result && letter == '-') result = -*result;
  } else if (letter >= 'A' && letter <= 'Z') {
    result = function(at);
  } else {
    result = number(at);
  }
  --depth_;
  return result;
}

double Expression::number(std::size_t& at) const {
  std::size_t end = at;
  if (end < text_.size() && (text_[end] == '-' || text_[end] == '+')) ++end;
  const std::size_t begin = at < text_.size() && text_[at] == '+' ? at + 1 : at;
  std::size_t digits = 0, points = 0;
  for (; end < text_.size() && (is_digit(text_[end]) || text_[end] == '.'); ++end) {
    ++(text_[end] == '.' ? points : digits);
  }
  double result = 0;
  if (digits == 0) refuse(at, "a number expected: digits, [an expression], a #parameter or a function");
  if (points > 1) refuse(at, "a number with more than one decimal point");
  const auto read = std::from_chars(text_.data() + begin, text_.data() + end, result, std::chars_format::fixed);
  if (read.ec != std::errc()) refuse(at, "the number is too large or too small");
  at = end;
  return result;
}

Name Expression::parameter_name(std::size_t& at) {
  const std::size_t place = at;
  if (grammar_.named && skip("<", at)) {
    const std::size_t end = text_.find('>', at);
    if (end == std::string_view::npos || end == at) refuse(place, "a parameter's name stands in < >");
    const std::string_view name = text_.substr(at, end - at);
    at = end + 1;
    return name;
  }
  const double number = value(at);
  const double nearest = std::round(number);
  if (!(std::abs(number - nearest) < kInteger) || nearest < grammar_.first || nearest > grammar_.last) {
    refuse(place,
           fmt::format("there is no parameter #{}; they go from {} to {}", number, grammar_.first, grammar_.last));
  }
  return static_cast<int>(nearest);
}

Maybe Expression::parameter(std::size_t& at) {
  const std::size_t place = at++;
  return variables_.value(parameter_name(at), place);
}

double Expression::exists(std::size_t& at) {
  expect('[', at);
  expect('#', at);
  const Name name = parameter_name(at);
  expect(']', at);
  return variables_.is_set(name) ? 1 : 0;
}

double Expression::atan(std::size_t& at) {
  expect('[', at);
  const double y = terms(kLeastLevel, at).value_or(0);
  if (grammar_.atan_of_one && skip(",", at)) {
    const double x = terms(kLeastLevel, at).value_or(0);
    expect(']', at);
    return grammar_.atan(y, x);
  }
  if (!skip("]", at)) refuse(at, "an operator or ] expected");
  const std::size_t behind = at;
  if (skip("/[", at)) {
    --at;
    return grammar_.atan(y, of_bracket(at));
  }
  if (!grammar_.atan_of_one) {
    if (!skip("/", at)) refuse(at, "ATAN has two values: ATAN[y]/[x]");
    return grammar_.atan(y, of_bracket(at));
  }
  at = behind;
  const double angle = grammar_.atan(std::abs(y), 1);
  return y < 0 ? -angle : angle;
}

double Expression::function(std::size_t& at) {
  const std::size_t place = at;
  if (grammar_.named && skip("EXISTS", at)) return exists(at);
  if (skip("ATAN", at)) return atan(at);
  const Function* found = find_word(grammar_.functions, text_, at);
  if (found == nullptr) refuse(place, "a number expected: digits, [an expression], a #parameter or a function");
  at += found->word.size();
  if (found->apply_two == nullptr) return finite(found->apply(of_bracket(at), place), place);
  expect('[', at);
  const double first = terms(kLeastLevel, at).value_or(0);
  expect(',', at);
  const double second = terms(kLeastLevel, at).value_or(0);
  expect(']', at);
  return finite(found->apply_two(first, second, place), place);
}

Maybe Expression::bracketed(std::size_t& at) {
  expect('[', at);
  const Maybe result = terms(kLeastLevel, at);
  if (!skip("]", at)) refuse(at, "an operator or ] expected");
  return result;
}

const Operator* Expression::operator_at(std::size_t at) const noexcept {
  return find_word(grammar_.operators, text_, at);
}

/// What binds no less than `level`.
Maybe Expression::terms(int level, std::size_t& at) {
  Maybe result = maybe(at);
  bool compared = false;
  while (true) {
    const Operator* found = operator_at(at);
    if (found == nullptr || found->level < level) return result;
    const std::size_t place = at;
    if (grammar_.comparisons_stand_alone && found->level == kLeastLevel && std::exchange(compared, true))
      refuse(place, "a second comparison within one bracket; write each into brackets of its own");
    at += found->word.size();
    const Maybe right = terms(found->level + 1, at);
    if (found->with_vacant != nullptr && !(result && right)) {
      result = found->with_vacant(!result && !right);
    } else {
      result = finite(found->apply(result.value_or(0), right.value_or(0), place), place);
    }
  }
}

}  // namespace rmac::gcode
