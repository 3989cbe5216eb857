#include "clients/legacy/rs274/flow/label.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clients/legacy/gcode/values/expression.hpp"
#include "clients/legacy/rs274/blocks/grammar.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// How far the number of a computed label may be from an integer, as in rs274, and the greatest.
constexpr double kInteger = 1e-4, kMostLabel = 2e9;

std::size_t behind_name(std::string_view text, std::size_t at) {
  const std::size_t end = text.find('>', at);
  if (end == std::string_view::npos || end == at + 1) refuse(at, "a name stands in < >");
  return end + 1;
}

std::size_t behind_brackets(std::string_view text, std::size_t at) {
  const std::size_t place = at;
  std::size_t depth = 0;
  do {
    if (at >= text.size()) refuse(place, "this bracket is not closed");
    if (text[at] == '<') {
      at = behind_name(text, at);
      continue;
    }
    if (text[at] == '[') ++depth;
    if (text[at] == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

std::size_t behind_digits(std::string_view text, std::size_t at) {
  return std::min(text.find_first_not_of("0123456789", at), text.size());
}

/// Where the value ends that begins with [ or #.
std::size_t behind_value(std::string_view text, std::size_t at) {
  const std::size_t place = at;
  at = std::min(text.find_first_not_of('#', at), text.size());
  if (text.substr(at).starts_with('[')) return behind_brackets(text, at);
  if (text.substr(at).starts_with('<')) return behind_name(text, at);
  const std::size_t end = behind_digits(text, at);
  if (end == at) refuse(place, "a parameter's number or name expected");
  return end;
}

}  // namespace

std::string computed_label(std::string_view text, std::size_t at, const Parameters& parameters) {
  const std::size_t place = at;
  const double value = gcode::Expression(text, grammar(), parameters).value(at);
  const double nearest = std::round(value);
  if (!(std::abs(value - nearest) < kInteger) || nearest < 0 || nearest > kMostLabel)
    refuse(place, fmt::format("{} is no number of an O word; it is 0 or a greater integer", value));
  return fmt::format("{:.0f}", nearest);
}

Label read_label(std::string_view text, std::size_t& at) {
  static const Parameters kNone;
  const std::size_t begin = at;
  const char first = at < text.size() ? text[at] : '\0';
  if (first == '<') {
    at = behind_name(text, at);
    return {std::string(text.substr(begin + 1, at - begin - 2))};
  }
  if (first == '[' || first == '#') {
    at = behind_value(text, at);
    std::string value(text.substr(begin, at - begin));
    if (value.find('#') != std::string::npos) return {std::move(value), true};
    return {computed_label(text, begin, kNone)};
  }
  at = behind_digits(text, at);
  if (at == begin) refuse(begin, "O is followed by a number, a <name> or [a value]");
  const std::size_t digits = std::min(text.find_first_not_of('0', begin), at - 1);
  return {std::string(text.substr(digits, at - digits))};
}

}  // namespace rmac::rs274
