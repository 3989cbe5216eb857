#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/apt/statements/statement.hpp"

namespace rmac::apt {

/// Takes a program apart into statements. `$` goes on with the next line, `$$` begins a comment; letters may be small,
/// blanks may stand anywhere but within a number, and lines may have any length.
class Scanner {
 public:
  /// `program` outlives this.
  explicit Scanner(std::string_view program) : program_(program) {}

  /// Reads the next statement. False at the program's end. Throws a Refusal.
  [[nodiscard]] bool next(Statement& statement);
  /// Lines that were read.
  [[nodiscard]] std::size_t lines() const noexcept { return line_; }

 private:
  struct Letter {
    char letter;
    std::size_t place;
  };

  bool take_line();
  void go_on(Statement& statement);
  void take_letters();
  [[nodiscard]] bool take_text(Statement& statement);
  void read_head(Statement& statement);
  void read_elements(std::vector<Element>& elements, int depth);
  void read_element(Element& element, int depth);
  void read_number(Element& element);
  void read_group(Element& group, int depth);
  [[nodiscard]] std::string read_word();
  [[nodiscard]] std::string read_majors();
  [[nodiscard]] char here() const noexcept { return at_ < letters_.size() ? letters_[at_].letter : '\0'; }
  [[nodiscard]] std::size_t place() const noexcept { return at_ < letters_.size() ? letters_[at_].place : end_; }

  std::string_view program_, source_;  ///< all of it, and the line that was taken
  std::size_t taken_ = 0, begin_ = 0;  ///< of the program, and where the line began
  std::size_t line_ = 0, end_ = 0;     ///< and where the statement's last line ends
  std::vector<Letter> letters_;        ///< of the statement, in capitals, without blanks
  std::size_t at_ = 0;
};

}  // namespace rmac::apt
