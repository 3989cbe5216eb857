#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rmac::rs274 {

/// A line of a program as the report reads it: without spaces, which may stand anywhere, in capitals, each comment a
/// kComment. One object reads many lines, so that none allocates.
class Line {
 public:
  static constexpr char kComment = '\x01';

  /// Throws a Refusal where a comment does not end.
  void read(std::string_view source);

  [[nodiscard]] std::string_view text() const noexcept { return text_; }
  /// Views of the source, without their marks.
  [[nodiscard]] const std::vector<std::string_view>& comments() const noexcept { return comments_; }
  /// Column of the source, from 1, of a place in text(); its end for a place behind it.
  [[nodiscard]] std::size_t column(std::size_t place) const noexcept;

 private:
  void keep(char letter, std::size_t column);

  std::string text_;
  std::vector<std::size_t> columns_;
  std::vector<std::string_view> comments_;
  std::size_t end_ = 1;
};

}  // namespace rmac::rs274
