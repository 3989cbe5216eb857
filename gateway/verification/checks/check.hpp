#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

namespace rmac::verifier {

/// Numbers by name, as a counter-example shows them.
struct NamedNumbers {
  std::string name;
  std::vector<double> numbers;
};

/// What a module did that it must not, and what it was given when it did. With these numbers it does it again.
struct CounterExample {
  std::string check;  ///< which property does not hold
  std::string what;   ///< in a sentence, with by how much
  std::int64_t sample = -1;
  std::vector<NamedNumbers> values;
};

/// Nothing, or the first counter-example that was found.
using Checked = tl::expected<void, CounterExample>;

/// What else is wrong with the calls that a check made, where somebody watches them: asked after each sample. It goes
/// before what it led to.
using Misdeed = std::function<Checked()>;

/// Of one sample: its misdeed, or else what was found.
[[nodiscard]] inline Checked misdeed_or(const Misdeed& misdeed, Checked checked) {
  if (!misdeed) return checked;
  if (auto proper = misdeed(); !proper) return proper;
  return checked;
}

[[nodiscard]] inline NamedNumbers named(std::string name, std::span<const double> numbers) {
  return {std::move(name), {numbers.begin(), numbers.end()}};
}

[[nodiscard]] inline tl::unexpected<CounterExample> found(std::string check, std::string what, std::int64_t sample,
                                                          std::vector<NamedNumbers> values) {
  return tl::unexpected<CounterExample>(CounterExample{std::move(check), std::move(what), sample, std::move(values)});
}

/// One line that says all of it, every number with all its digits.
[[nodiscard]] std::string to_string(const CounterExample& example);

}  // namespace rmac::verifier
