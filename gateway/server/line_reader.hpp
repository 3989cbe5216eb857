#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rmac::gateway {

/// Cuts what arrives into lines. Blank ones are left out, and so is a carriage return at a line's end.
class LineReader {
 public:
  struct Line {
    std::string_view text;       ///< until the next call
    std::uint64_t position = 0;  ///< of its first byte in the input
  };

  explicit LineReader(std::size_t limit_bytes) : limit_bytes_(limit_bytes) {}

  /// What arrived; it must last until `next` has given its lines.
  void take(std::string_view chunk) noexcept { chunk_ = chunk; }
  /// The next whole line of it, or nothing.
  [[nodiscard]] std::optional<Line> next();
  /// The line without a newline at the end of all input, or nothing.
  [[nodiscard]] std::optional<Line> last();
  /// Whether a line is longer than the limit: `next` gives no more then.
  [[nodiscard]] bool too_long() const noexcept { return too_long_; }
  /// Of the line whose end has not arrived.
  [[nodiscard]] std::size_t held_bytes() const noexcept { return begun_.capacity(); }
  /// Forgets what it holds.
  void clear() noexcept;

 private:
  [[nodiscard]] std::optional<Line> line_of(std::string_view text);

  std::size_t limit_bytes_;
  std::string_view chunk_;  ///< what is left of it
  std::string begun_;       ///< the line whose end has not arrived
  std::string line_;        ///< the line that `next` gave last, where it came in pieces
  std::uint64_t position_ = 0;
  bool too_long_ = false;
};

}  // namespace rmac::gateway
