#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "clients/legacy/apt/interpreter.hpp"
#include "clients/legacy/apt/statements/synonyms.hpp"

namespace rmac::apt {

/// Hands statements to the interpreter, those of a passage again where the program says so: INDEX to COPY, a MACRO by
/// its CALL, and a subprogram (DEFSUB) by CALSUB.
class Passages {
 public:
  Passages(Interpreter& interpreter, Writer& writer) : interpreter_(interpreter), writer_(writer) {}

  /// Of the program, in the words of the language or their synonyms (SYN). Throws a Refusal. False where the program
  /// ends.
  [[nodiscard]] bool take(Statement& statement);
  /// The text ends.
  void end(std::size_t place);

 private:
  /// Statements that are repeated.
  struct Passage {
    std::vector<Statement> statements;
    std::vector<Element> parameters;  ///< of a macro: words, or words with what they are unless a call says it
    std::size_t place = 0;
    int depth = 0;  ///< of calls and copies in which it began
  };

  [[nodiscard]] bool take_meant(const Statement& statement);
  void begin(const std::string& name, Arguments& arguments, const Statement& statement);
  void define(const Statement& statement);
  void index(Arguments& arguments);
  void copy(Arguments& arguments);
  void call(const Statement& statement);
  void call_subprogram(Arguments& arguments);
  void count_repeated(std::size_t place);
  void run(const std::vector<Statement>& statements, std::size_t place);
  [[nodiscard]] bool take_verb(const Statement& statement);

  Interpreter& interpreter_;
  Writer& writer_;
  Synonyms synonyms_;
  std::map<std::string, Passage> named_;  ///< macros by their names, subprograms as #n
  std::map<int, Passage> indexed_;        ///< whose COPY has not come
  std::string defining_;                  ///< the one that is being read; empty without
  int depth_ = 0;
  std::size_t repeated_ = 0;
};

}  // namespace rmac::apt
