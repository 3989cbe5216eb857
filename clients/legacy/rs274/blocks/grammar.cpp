#include "clients/legacy/rs274/blocks/grammar.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "clients/legacy/rs274/blocks/parameters.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

constexpr double kDegree = std::numbers::pi / 180;
/// LinuxCNC's: two values that differ by less are EQ.
constexpr double kSame = 1e-4;

double truth(bool value) {
  return value ? 1 : 0;
}

double divide(double left, double right, std::size_t place) {
  if (right == 0) refuse(place, "a division by zero");
  return left / right;
}

/// As the report has it: of the sign of no one, between 0 and the divisor's amount.
double modulo(double left, double right, std::size_t place) {
  if (right == 0) refuse(place, "MOD by zero");
  const double rest = std::fmod(left, right);
  return rest < 0 ? rest + std::abs(right) : rest;
}

double power(double base, double exponent, std::size_t place) {
  if (base < 0 && exponent != std::floor(exponent)) refuse(place, "a negative number has no such power");
  if (base == 0 && exponent < 0) refuse(place, "zero has no negative power");
  return std::pow(base, exponent);
}

double root(double value, std::size_t place) {
  if (value < 0) refuse(place, "the square root of a negative number");
  return std::sqrt(value);
}

double logarithm(double value, std::size_t place) {
  if (value <= 0) refuse(place, "the logarithm of a number that is not positive");
  return std::log(value);
}

double within_one(double value, std::size_t place) {
  if (std::abs(value) > 1) refuse(place, "the arc of a number beyond -1 to 1");
  return value;
}

// A word that another begins with stands behind it.
constexpr auto kOperators = std::to_array<Operator>({
    {"**", 5, power},
    {"*", 4, [](double a, double b, std::size_t) { return a * b; }},
    {"/", 4, divide},
    {"MOD", 4, modulo},
    {"+", 3, [](double a, double b, std::size_t) { return a + b; }},
    {"-", 3, [](double a, double b, std::size_t) { return a - b; }},
    {"EQ", 2, [](double a, double b, std::size_t) { return truth(std::abs(a - b) < kSame); }},
    {"NE", 2, [](double a, double b, std::size_t) { return truth(std::abs(a - b) >= kSame); }},
    {"GT", 2, [](double a, double b, std::size_t) { return truth(a > b); }},
    {"GE", 2, [](double a, double b, std::size_t) { return truth(a >= b); }},
    {"LT", 2, [](double a, double b, std::size_t) { return truth(a < b); }},
    {"LE", 2, [](double a, double b, std::size_t) { return truth(a <= b); }},
    {"AND", 1, [](double a, double b, std::size_t) { return truth(a != 0 && b != 0); }},
    {"OR", 1, [](double a, double b, std::size_t) { return truth(a != 0 || b != 0); }},
    {"XOR", 1, [](double a, double b, std::size_t) { return truth((a != 0) != (b != 0)); }},
});

constexpr auto kFunctions = std::to_array<Function>({
    {"ABS", [](double x, std::size_t) { return std::abs(x); }},
    {"ACOS", [](double x, std::size_t at) { return std::acos(within_one(x, at)) / kDegree; }},
    {"ASIN", [](double x, std::size_t at) { return std::asin(within_one(x, at)) / kDegree; }},
    {"COS", [](double x, std::size_t) { return std::cos(x * kDegree); }},
    {"EXP", [](double x, std::size_t) { return std::exp(x); }},
    {"FIX", [](double x, std::size_t) { return std::floor(x); }},
    {"FUP", [](double x, std::size_t) { return std::ceil(x); }},
    {"LN", logarithm},
    {"ROUND", [](double x, std::size_t) { return std::round(x); }},
    {"SIN", [](double x, std::size_t) { return std::sin(x * kDegree); }},
    {"SQRT", root},
    {"TAN", [](double x, std::size_t) { return std::tan(x * kDegree); }},
});

constexpr Grammar kGrammar{
    .operators = kOperators,
    .functions = kFunctions,
    .atan = [](double y, double x) { return std::atan2(y, x) * 180 / std::numbers::pi; },
    .named = true,
    .last = Parameters::kLast,
};

}  // namespace

const Grammar& grammar() noexcept {
  return kGrammar;
}

}  // namespace rmac::rs274
