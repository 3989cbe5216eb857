#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rmac::apt {

/// What stands between the commas of a statement.
struct Element {
  enum class Kind {
    Empty,  ///< nothing: `TOOLNO/1,,10`
    Word,   ///< in capitals
    Number,
    Group,     ///< a statement in parentheses: its major word is `word`, its elements `inner`
    Assigned,  ///< `word` = the one of `inner`, as a call of a macro has it
  };
  Kind kind = Kind::Empty;
  std::string word;
  double value = 0;
  std::size_t place = 0;
  std::vector<Element> inner;
};

/// One statement, on as many lines as it takes: `major/element,element,…`.
struct Statement {
  std::size_t line = 0;   ///< where it begins, from 1
  std::size_t place = 0;  ///< likewise
  std::string name;       ///< `NAME=` before the major word; empty without
  std::string major;      ///< in capitals, without blanks, with its commas: `TLON,GOFWD`
  bool is_text = false;   ///< a comment (its major word is `$$`), or a statement that is a text behind its major word
  std::string text;
  std::vector<Element> elements;
};

}  // namespace rmac::apt
