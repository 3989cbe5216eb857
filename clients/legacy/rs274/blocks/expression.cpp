#include "clients/legacy/rs274/blocks/expression.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <numbers>

#include "clients/legacy/rs274/blocks/operators.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

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

}  // namespace

bool Expression::skip(std::string_view word, std::size_t& at) const noexcept {
  if (at > text_.size() || !text_.substr(at).starts_with(word)) return false;
  at += word.size();
  return true;
}

void Expression::expect(char letter, std::size_t& at) const {
  if (!skip({&letter, 1}, at)) refuse(at, fmt::format("{} expected", letter));
}

double Expression::value(std::size_t& at) {
  if (++depth_ > kDeepest) refuse(at, fmt::format("values nested more than {} deep", kDeepest));
  double result = 0;
  const char letter = at < text_.size() ? text_[at] : '\0';
  const char next = at + 1 < text_.size() ? text_[at + 1] : '\0';
  if (letter == '[') {
    result = bracketed(at);
  } else if (letter == '#') {
    result = parameter(at);
  } else if ((letter == '-' || letter == '+') && (next == '[' || next == '#' || (next >= 'A' && next <= 'Z'))) {
    ++at;
    result = letter == '-' ? -value(at) : value(at);
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

Expression::Name Expression::parameter_name(std::size_t& at) {
  const std::size_t place = at;
  if (skip("<", at)) {
    const std::size_t end = text_.find('>', at);
    if (end == std::string_view::npos || end == at) refuse(place, "a parameter's name stands in < >");
    const std::string_view name = text_.substr(at, end - at);
    at = end + 1;
    return name;
  }
  const double number = value(at);
  const double nearest = std::round(number);
  if (!(std::abs(number - nearest) < kInteger) || nearest < 1 || nearest > Parameters::kLast) {
    refuse(place, fmt::format("there is no parameter #{}; they go from 1 to {}", number, Parameters::kLast));
  }
  return static_cast<int>(nearest);
}

double Expression::parameter(std::size_t& at) {
  const std::size_t place = at++;
  const Name name = parameter_name(at);
  if (const auto* text = std::get_if<std::string_view>(&name)) {
    if (const auto found = parameters_.read(*text)) return *found;
    refuse(place, fmt::format("#<{}> was not set before; set it in the program", *text));
  }
  const int number = std::get<int>(name);
  if (const auto found = parameters_.read(number)) return *found;
  if (number >= Parameters::kFirstOfControl) {
    refuse(place, fmt::format("#{} is the control's own, and not known here; write the value instead", number));
  }
  refuse(place, fmt::format("#{} was not set before, and what a machine has in it is not known; set it in the program",
                            number));
}

double Expression::exists(std::size_t& at) {
  expect('[', at);
  expect('#', at);
  const Name name = parameter_name(at);
  expect(']', at);
  const auto* text = std::get_if<std::string_view>(&name);
  return (text != nullptr ? parameters_.read(*text) : parameters_.read(std::get<int>(name))) ? 1 : 0;
}

double Expression::function(std::size_t& at) {
  const std::size_t place = at;
  if (skip("EXISTS", at)) return exists(at);
  if (skip("ATAN", at)) {
    const double y = bracketed(at);
    if (!skip("/", at)) refuse(at, "ATAN has two values: ATAN[y]/[x]");
    const double x = bracketed(at);
    return std::atan2(y, x) * 180 / std::numbers::pi;
  }
  const Function* found = function_at(text_, at);
  if (found == nullptr) refuse(place, "a number expected: digits, [an expression], a #parameter or a function");
  at += found->word.size();
  return finite(found->apply(bracketed(at), place), place);
}

double Expression::bracketed(std::size_t& at) {
  expect('[', at);
  const double result = terms(kLeastLevel, at);
  if (!skip("]", at)) refuse(at, "an operator or ] expected");
  return result;
}

/// What binds no less than `level`.
double Expression::terms(int level, std::size_t& at) {
  double result = value(at);
  while (true) {
    const Operator* found = operator_at(text_, at);
    if (found == nullptr || found->level < level) return result;
    const std::size_t place = at;
    at += found->word.size();
    result = finite(found->apply(result, terms(found->level + 1, at), place), place);
  }
}

}  // namespace rmac::rs274
