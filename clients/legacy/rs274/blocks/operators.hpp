#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rmac::rs274 {

/// A binary operator. Of equal levels the left one comes first, `**` too.
struct Operator {
  std::string_view word;
  int level = 0;  ///< 1 binds least
  double (*apply)(double left, double right, std::size_t place) = nullptr;
};

inline constexpr int kLeastLevel = 1;

/// The operator that stands there; null where none does.
[[nodiscard]] const Operator* operator_at(std::string_view text, std::size_t at) noexcept;

/// A function of one value (degrees where it has an angle); null where none of this name stands there.
struct Function {
  std::string_view word;
  double (*apply)(double value, std::size_t place) = nullptr;
};
[[nodiscard]] const Function* function_at(std::string_view text, std::size_t at) noexcept;

}  // namespace rmac::rs274
