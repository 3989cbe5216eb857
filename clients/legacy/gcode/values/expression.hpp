#pragma once

#include <cstddef>
#include <string_view>

#include "clients/legacy/gcode/values/grammar.hpp"

namespace rmac::gcode {

/// Reads values out of a line: numbers, [expressions], #parameters and functions. Each call begins at `at` and leaves
/// it behind what it read; what is no value throws a Refusal.
class Expression {
 public:
  Expression(std::string_view text, const Grammar& grammar, const Variables& variables)
      : text_(text), grammar_(grammar), variables_(variables) {}

  /// A vacant one is 0.
  [[nodiscard]] double value(std::size_t& at) { return maybe(at).value_or(0); }
  [[nodiscard]] Maybe maybe(std::size_t& at);
  /// The same with operators, as far as they go.
  [[nodiscard]] Maybe without_brackets(std::size_t& at) { return terms(kLeastLevel, at); }
  [[nodiscard]] Name parameter_name(std::size_t& at);

 private:
  static constexpr int kLeastLevel = 1;  ///< of the operator that binds least

  [[nodiscard]] bool skip(std::string_view word, std::size_t& at) const noexcept;
  void expect(char letter, std::size_t& at) const;
  [[nodiscard]] double number(std::size_t& at) const;
  [[nodiscard]] Maybe parameter(std::size_t& at);
  [[nodiscard]] double function(std::size_t& at);
  [[nodiscard]] double exists(std::size_t& at);
  [[nodiscard]] double atan(std::size_t& at);
  [[nodiscard]] Maybe bracketed(std::size_t& at);
  [[nodiscard]] double of_bracket(std::size_t& at) { return bracketed(at).value_or(0); }
  [[nodiscard]] Maybe terms(int level, std::size_t& at);
  [[nodiscard]] const Operator* operator_at(std::size_t at) const noexcept;

  std::string_view text_;
  const Grammar& grammar_;
  const Variables& variables_;
  int depth_ = 0;
};

}  // namespace rmac::gcode
