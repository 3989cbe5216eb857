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
#include "clients/legacy/rs274/flow/outline.hpp"

namespace rmac::rs274 {

using gcode::Bounds, gcode::Endless, gcode::Made;

/// A program's lines in the order in which they are carried out: O words are carried out here, and all other lines are
/// given out, whatever they are. What is no program throws a Refusal, whose place is in line().
class Flow {
 public:
  /// The program and the parameters outlive it. `made` is asked where lines come again.
  Flow(std::string_view program, bool block_delete, Bounds bounds, Parameters& parameters, std::function<Made()> made);

  /// Goes on to the next line that is no statement with O. False at the end of the text.
  [[nodiscard]] bool next();
  /// The one that was come to last.
  [[nodiscard]] const Line& line() const noexcept { return line_; }
  /// Its number in the source, from 1; 0 before the first.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  /// The greatest number that was come to.
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
  /// Where to go on: a byte of the source where a line begins, how many lines are before it, and the next statement.
  struct Position {
    std::size_t at = 0, lines = 0, statement = 0;
  };
  /// A sub or numbered program that runs.
  struct Call {
    std::size_t statement = 0;  ///< of its begin
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
  void enter(std::size_t statement, int more_times, std::size_t place);
  void return_from_sub(const Statement& statement);
  void leave_call();

  [[nodiscard]] const Statement& at(std::size_t statement) const { return outline_.statements()[statement]; }
  [[nodiscard]] double value(const Statement& statement) const;
  [[nodiscard]] Parameters::Arguments arguments(const Statement& statement) const;
  void go_before(std::size_t statement);
  void go_behind(std::size_t statement);
  void require_whole(const Statement& statement);
  [[noreturn]] void refuse_trouble();

  std::string_view program_;
  Outline outline_;
  Parameters& parameters_;
  Endless endless_;
  Line line_;
  Position next_;
  std::size_t number_ = 0, furthest_ = 0;
  std::vector<Call> calls_;
  std::vector<Repeat> repeats_;
};

}  // namespace rmac::rs274
