#pragma once

#include <cstddef>
#include <string_view>
#include <variant>

#include "clients/legacy/rs274/blocks/parameters.hpp"

namespace rmac::rs274 {

/// Reads values out of a line: numbers, [expressions], #parameters and functions. Each call begins at `at` and leaves
/// it behind what it read; what is no value throws a Refusal.
class Expression {
 public:
  Expression(std::string_view text, const Parameters& parameters) : text_(text), parameters_(parameters) {}

  [[nodiscard]] double value(std::size_t& at);
  /// What stands behind a `#`: a number, or a name.
  using Name = std::variant<int, std::string_view>;
  [[nodiscard]] Name parameter_name(std::size_t& at);

 private:
  [[nodiscard]] bool skip(std::string_view word, std::size_t& at) const noexcept;
  void expect(char letter, std::size_t& at) const;
  [[nodiscard]] double number(std::size_t& at) const;
  [[nodiscard]] double parameter(std::size_t& at);
  [[nodiscard]] double function(std::size_t& at);
  [[nodiscard]] double exists(std::size_t& at);
  [[nodiscard]] double bracketed(std::size_t& at);
  [[nodiscard]] double terms(int level, std::size_t& at);

  std::string_view text_;
  const Parameters& parameters_;
  int depth_ = 0;
};

}  // namespace rmac::rs274
