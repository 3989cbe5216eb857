#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace rmac::fanuc {

/// How a line begins: / or /2, N with its number, and comments.
struct LineHead {
  bool deletes = false;       ///< it is left out where the panel's switch is on
  std::optional<int> number;  ///< N
  std::size_t behind = 0;     ///< where the rest stands, behind comments
};

/// `text`: as Line::text(). Throws a Refusal where N has no number that a line may have.
[[nodiscard]] LineHead read_head(std::string_view text);

/// Digits at `at`, and leaves `at` behind them; none where there is none, or more than nine.
[[nodiscard]] std::optional<int> read_digits(std::string_view text, std::size_t& at) noexcept;

}  // namespace rmac::fanuc
