#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/blocks/line.hpp"
#include "clients/legacy/gcode/flow/endless.hpp"
#include "clients/legacy/rs274/blocks/parameters.hpp"
#include "clients/legacy/rs274/flow/sources.hpp"

namespace rmac::rs274 {

using gcode::Bounds, gcode::Endless, gcode::Made;

/// What a Flow asks of who carries its lines out.
struct Asked {
  std::function<Made()> made;  ///< where lines come again
  FindFile find_file{};
  std::function<void(std::size_t place)> leaving{};  ///< a sub or numbered program ends, and is still what runs
};

/// A program's lines, and those of the files that it calls, in the order in which they are carried out: O words are
/// carried out here, and all other lines are given out, whatever they are. What is no program throws a Refusal, whose
/// place is in line().
class Flow {
 public:
  /// The program and the parameters outlive it.
  Flow(std::string_view program, bool block_delete, Bounds bounds, Parameters& parameters, Asked asked);

  /// Goes on to the next line that is no statement with O. False at the end of the text.
  [[nodiscard]] bool next();
  /// The one that was come to last.
  [[nodiscard]] const Line& line() const noexcept { return line_; }
  /// Its number in its text, from 1; 0 before the first.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  /// The file that it stands in; empty for the program itself.
  [[nodiscard]] const std::string& file() const noexcept { return read_from_->file; }
  /// The line of the program itself that has it carried out: it, or a call.
  [[nodiscard]] std::size_t line_of_program() const noexcept;
  /// The greatest number of the program's that was come to.
  [[nodiscard]] std::size_t furthest() const noexcept { return furthest_; }
  /// `O100` of the numbered program or sub that runs; empty in the main program.
  [[nodiscard]] std::string running() const;

  /// How many of those run within each other.
  [[nodiscard]] std::size_t call_level() const noexcept { return calls_.size(); }

  /// M98, in the line that was given out: the numbered program, that many times. `place`: for a Refusal.
  void call(int label, int times, std::size_t place);
  /// M99, likewise.
  void end_of_numbered(std::size_t place);

 private:
  /// Where to go on: a byte of a text where a line begins, how many lines are before it, and the next statement.
  struct Position {
    const Source* source = nullptr;
    std::size_t at = 0, lines = 0, statement = 0;
  };
  /// What a call calls.
  struct Callee {
    const Source* source = nullptr;
    std::size_t statement = 0;
  };
  /// A sub or numbered program that runs.
  struct Call {
    std::size_t statement = 0;  ///< of its begin, in its own text
    Position back;
    int more_times = 0;
    std::size_t repeats = 0;  ///< how many repeats the caller is in
  };
  struct Repeat {
    std::size_t statement = 0;
    double more_times = 0;
  };

  void read_line();
  void carry_out(std::size_t index);
  void begin_repeat(std::size_t index);
  void end_repeat(std::size_t index);
  void go_to_branch(std::size_t index);
  void leave_loop(const Statement& statement);
  void call_sub(const Statement& statement);
  [[nodiscard]] Callee find(const std::string& label, bool numbered, std::size_t place);
  [[nodiscard]] std::optional<Callee> find_in_texts(const std::string& label, bool numbered) const;
  void enter(const Callee& callee, int more_times, std::size_t place);
  void return_from_sub(const Statement& statement);
  void leave_call(std::size_t place);

  [[nodiscard]] const Statement& at(std::size_t statement) const {
    return next_.source->outline.statements()[statement];
  }
  [[nodiscard]] double value(const Statement& statement) const;
  [[nodiscard]] Parameters::Arguments arguments(const Statement& statement) const;
  void go_before(std::size_t statement);
  void go_behind(std::size_t statement);
  void require_whole(const Source& source, std::size_t statement);
  [[noreturn]] void refuse_trouble(const Source& source);

  Sources sources_;
  Parameters& parameters_;
  Endless endless_;
  std::function<void(std::size_t)> leaving_;
  Line line_;
  Position next_;
  const Source* read_from_ = nullptr;  ///< what line_ stands in
  std::size_t number_ = 0, furthest_ = 0;
  std::vector<Call> calls_;
  std::vector<Repeat> repeats_;
};

}  // namespace rmac::rs274
