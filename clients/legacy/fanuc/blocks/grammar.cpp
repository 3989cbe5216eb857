#include "clients/legacy/fanuc/blocks/grammar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/blocks/variables.hpp"

namespace rmac::fanuc {

namespace {

using gcode::Function, gcode::Operator;

constexpr double kDegree = std::numbers::pi / 180;
/// Values that differ by less than this part of them are one: a control keeps fewer digits, and in decimals.
constexpr double kSame = 1e-9;
/// How far a number may be from an integer where bits are meant.
constexpr double kInteger = 1e-6;

double truth(bool value) {
  return value ? 1 : 0;
}

bool same(double a, double b) {
  return std::abs(a - b) <= kSame * std::max({1.0, std::abs(a), std::abs(b)});
}

/// The integer that a value is but for rounding, or else what `cut` makes of it.
template <typename Cut>
double integral(double value, Cut cut) {
  const double nearest = std::round(value);
  return same(value, nearest) ? nearest : cut(value);
}

double fix(double value, std::size_t) {
  return integral(value, [](double x) { return std::trunc(x); });
}

double fup(double value, std::size_t) {
  return integral(value, [](double x) { return x < 0 ? std::floor(x) : std::ceil(x); });
}

double divide(double left, double right, std::size_t place) {
  if (right == 0) refuse(place, "a division by zero");
  return left / right;
}

std::int64_t integer(double value, std::size_t place) {
  constexpr double kMost = 4294967295;
  const double nearest = std::round(value);
  if (!(std::abs(value - nearest) <= kInteger && std::abs(nearest) <= kMost))
    refuse(place, "MOD, AND, OR, XOR, BIN and BCD take whole numbers; write FIX or ROUND around the others");
  return static_cast<std::int64_t>(nearest);
}

double bits(double value, std::size_t place) {
  const std::int64_t number = integer(value, place);
  if (number < 0) refuse(place, "AND, OR, XOR, BIN and BCD take no negative numbers");
  return static_cast<double>(number);
}

std::uint64_t word(double value, std::size_t place) {
  return static_cast<std::uint64_t>(bits(value, place));
}

double modulo(double left, double right, std::size_t place) {
  const std::int64_t divisor = integer(right, place);
  if (divisor == 0) refuse(place, "MOD by zero");
  return static_cast<double>(integer(left, place) % divisor);
}

double root(double value, std::size_t place) {
  if (value < 0) refuse(place, "the square root of a negative number");
  return std::sqrt(value);
}

double logarithm(double value, std::size_t place) {
  if (value <= 0) refuse(place, "the logarithm of a number that is not positive");
  return std::log(value);
}

double power(double base, double exponent, std::size_t place) {
  if (base < 0 && exponent != std::floor(exponent)) refuse(place, "a negative number has no such power");
  if (base == 0 && exponent < 0) refuse(place, "zero has no negative power");
  return std::pow(base, exponent);
}

double within_one(double value, std::size_t place) {
  if (std::abs(value) > 1) refuse(place, "the arc of a number beyond -1 to 1");
  return value;
}

double whole_turn(double degrees) {
  return degrees < 0 ? degrees + 360 : degrees;
}

/// Between decimal digits of four bits each and a number.
double recoded(double value, std::uint64_t from, std::uint64_t to, std::size_t place) {
  std::uint64_t rest = word(value, place), result = 0;
  for (std::uint64_t weight = 1; rest != 0; weight *= to) {
    const std::uint64_t digit = rest % from;
    if (digit > 9) refuse(place, "BIN takes a number whose digits of four bits are 0 to 9");
    result += digit * weight;
    rest /= from;
  }
  return static_cast<double>(result);
}

template <int kDigits>
double rounded(double value, std::size_t) {
  double per_unit = 1;
  for (int digit = 0; digit < kDigits; ++digit) per_unit *= 10;
  return std::round(value * per_unit) / per_unit;
}

constexpr auto kOperators = std::to_array<Operator>({
    {"*", 3, [](double a, double b, std::size_t) { return a * b; }},
    {"/", 3, divide},
    {"MOD", 3, modulo},
    {"AND", 3, [](double a, double b, std::size_t at) { return static_cast<double>(word(a, at) & word(b, at)); }},
    {"+", 2, [](double a, double b, std::size_t) { return a + b; }},
    {"-", 2, [](double a, double b, std::size_t) { return a - b; }},
    {"OR", 2, [](double a, double b, std::size_t at) { return static_cast<double>(word(a, at) | word(b, at)); }},
    {"XOR", 2, [](double a, double b, std::size_t at) { return static_cast<double>(word(a, at) ^ word(b, at)); }},
    {"EQ", 1, [](double a, double b, std::size_t) { return truth(same(a, b)); }, [](bool both) { return truth(both); }},
    {"NE", 1, [](double a, double b, std::size_t) { return truth(!same(a, b)); },
     [](bool both) { return truth(!both); }},
    {"GT", 1, [](double a, double b, std::size_t) { return truth(a > b && !same(a, b)); }},
    {"GE", 1, [](double a, double b, std::size_t) { return truth(a >= b || same(a, b)); }},
    {"LT", 1, [](double a, double b, std::size_t) { return truth(a < b && !same(a, b)); }},
    {"LE", 1, [](double a, double b, std::size_t) { return truth(a <= b || same(a, b)); }},
});

template <int kDigits>
constexpr auto kFunctionsOf = std::to_array<Function>({
    {"ABS", [](double x, std::size_t) { return std::abs(x); }},
    {"ACOS", [](double x, std::size_t at) { return std::acos(within_one(x, at)) / kDegree; }},
    {"ASIN", [](double x, std::size_t at) { return whole_turn(std::asin(within_one(x, at)) / kDegree); }},
    {"BCD", [](double x, std::size_t at) { return recoded(x, 10, 16, at); }},
    {"BIN", [](double x, std::size_t at) { return recoded(x, 16, 10, at); }},
    {"COS", [](double x, std::size_t) { return std::cos(x * kDegree); }},
    {"EXP", [](double x, std::size_t) { return std::exp(x); }},
    {"FIX", fix},
    {"FUP", fup},
    {"LN", logarithm},
    {"POW", nullptr, power},
    {"ROUND", rounded<kDigits>},
    {"SIN", [](double x, std::size_t) { return std::sin(x * kDegree); }},
    {"SQRT", root},
    {"SQR", root},
    {"TAN", [](double x, std::size_t) { return std::tan(x * kDegree); }},
});

template <int kDigits>
constexpr Grammar kGrammarOf{
    .operators = kOperators,
    .functions = kFunctionsOf<kDigits>,
    .atan = [](double y, double x) { return whole_turn(std::atan2(y, x) / kDegree); },
    .atan_of_one = true,
    .comparisons_stand_alone = true,
    .first = 0,
    .last = Variables::kLast,
};

constexpr auto kSyntaxOperators = [] {
  auto operators = kOperators;
  for (Operator& each : operators) each.apply = [](double, double, std::size_t) { return 1.0; };
  return operators;
}();

constexpr auto kSyntaxFunctions = [] {
  auto functions = kFunctionsOf<0>;
  for (Function& each : functions) {
    if (each.apply != nullptr) each.apply = [](double, std::size_t) { return 1.0; };
    if (each.apply_two != nullptr) each.apply_two = [](double, double, std::size_t) { return 1.0; };
  }
  return functions;
}();

constexpr Grammar kSyntaxGrammar{
    .operators = kSyntaxOperators,
    .functions = kSyntaxFunctions,
    .atan = [](double, double) { return 1.0; },
    .atan_of_one = true,
    .comparisons_stand_alone = true,
    .first = 0,
    .last = Variables::kLast,
};

}  // namespace

const Grammar& grammar_of_syntax() noexcept {
  return kSyntaxGrammar;
}

const Grammar& grammar() noexcept {
  return kGrammarOf<0>;
}

const Grammar& grammar_of_words(bool inch) noexcept {
  return inch ? kGrammarOf<4> : kGrammarOf<3>;
}

}  // namespace rmac::fanuc
