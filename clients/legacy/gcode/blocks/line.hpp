#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace rmac::gcode {

/// How a comment begins that goes on to the end of its line; every language has ( ).
enum class LineComments { Semicolon, None };

/// A line of a program as the report reads it: without spaces, which may stand anywhere, in capitals, each comment a
/// kComment. One object reads many lines, so that none allocates; the source of the last is to be there still.
class Line {
 public:
  static constexpr char kComment = '\x01';

  /// Throws a Refusal where a comment does not end.
  void read(std::string_view source, LineComments comments = LineComments::Semicolon);

  [[nodiscard]] std::string_view text() const noexcept { return text_; }
  /// Views of the source, without their marks.
  [[nodiscard]] const std::vector<std::string_view>& comments() const noexcept { return comments_; }
  /// Column of the source, from 1, of a place in text(); its end for a place behind it.
  [[nodiscard]] std::size_t column(std::size_t place) const noexcept;

 private:
  void read_comment(std::size_t& at, std::size_t end);

  std::string text_;
  std::string_view source_;
  LineComments line_comments_ = LineComments::Semicolon;
  std::vector<std::string_view> comments_;
  std::size_t unreadable_ = std::string_view::npos;  ///< a byte of the source that stands in no line
};

}  // namespace rmac::gcode
