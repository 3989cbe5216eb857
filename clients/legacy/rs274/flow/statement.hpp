#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <string_view>

#include "clients/legacy/gcode/blocks/line.hpp"

namespace rmac::rs274 {

using gcode::Line;

/// What a line that begins with O is. Program is the bare `O100` with which a numbered program begins; EndDo is the
/// `while` of a `do`; Trouble is a line that is none of these, or stands where it must not.
enum class Keyword {
  Program,
  Sub,
  EndSub,
  Call,
  Return,
  Do,
  EndDo,
  While,
  EndWhile,
  Repeat,
  EndRepeat,
  If,
  ElseIf,
  Else,
  EndIf,
  Break,
  Continue,
  Trouble
};

/// As programs write it, in small letters.
[[nodiscard]] std::string_view word_of(Keyword keyword) noexcept;

/// A line that begins with O, and what it belongs to: indices of other statements of its Outline.
struct Statement {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  Keyword keyword = Keyword::Program;
  std::string label;            ///< digits, a name in capitals, or the text of a value
  bool computed = false;        ///< the label is the text of a value that parameters decide
  std::size_t place = 0;        ///< of O in Line::text()
  std::size_t arguments = 0;    ///< likewise, behind the keyword
  std::size_t line = 0;         ///< of the source, from 1
  std::size_t begin = 0;        ///< of that line in the source
  std::size_t end = 0;          ///< where the line behind it begins
  std::size_t opening = kNone;  ///< what its block begins with; of break, continue and return the block to leave
  std::size_t ending = kNone;   ///< what its block ends with
  std::size_t branch = kNone;   ///< of if and elseif: the elseif, else or endif behind it

  /// As in `o100` or `o<pocket>`.
  [[nodiscard]] std::string name() const;
};

/// The name of a label that is a number or a name.
[[nodiscard]] std::string name_of(std::string_view label);

/// Reads label and keyword of a line whose O is at `place`. Throws a Refusal for what is no statement.
[[nodiscard]] Statement read_statement(const Line& line, std::size_t place);

/// Throws a Refusal unless nothing but comments stands there.
void require_end(std::string_view text, std::size_t at);

}  // namespace rmac::rs274
