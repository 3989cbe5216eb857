#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/fanuc/blocks/arguments.hpp"
#include "clients/legacy/fanuc/blocks/reader.hpp"
#include "clients/legacy/fanuc/flow/outline.hpp"
#include "clients/legacy/gcode/flow/endless.hpp"

namespace rmac::fanuc {

/// A file's lines in the order in which they are carried out. Statements of macros are carried out here, and blocks are
/// given out. What is no program throws a Refusal, whose place is in line().
class Flow {
 public:
  /// The text, the variables and the modes outlive it. `made` is asked where lines come again.
  Flow(std::string_view text, bool block_delete, gcode::Bounds bounds, Variables& variables, const gcode::Modes& modes,
       std::function<gcode::Made()> made);

  /// Goes on to the next line that is no statement. False at the end of the text.
  [[nodiscard]] bool next();
  /// The one that was come to last, and where its words begin.
  [[nodiscard]] const gcode::Line& line() const noexcept { return line_; }
  [[nodiscard]] std::size_t words() const noexcept { return words_; }
  /// Its number in the source, from 1; 0 before the first.
  [[nodiscard]] std::size_t number() const noexcept { return next_.lines; }
  /// No other file than the program's is read.
  [[nodiscard]] std::size_t line_of_program() const noexcept { return number(); }
  [[nodiscard]] static std::string file() { return {}; }
  [[nodiscard]] std::size_t furthest() const noexcept { return furthest_; }
  /// N of the last line that had one, and O of the program that runs; 0 and kUnnumbered where there is none.
  [[nodiscard]] int last_label() const noexcept { return last_label_; }
  [[nodiscard]] int program() const { return outline_.programs()[frames_.back().program].number; }
  /// `O100` of what M98 or G65 called, `N100` of what M97 did, and M99 ends; empty in the main program.
  [[nodiscard]] std::string running() const;

  /// Whether G66 calls behind the moves of this program.
  [[nodiscard]] bool calls_behind_moves() const noexcept { return modal_.has_value(); }
  /// What the block that was given out asks for. `moved`: it moved the tool, so that G66 calls.
  void go_on(const Ordered& ordered, bool moved);

 private:
  enum class Kind { Subprogram, Macro, Modal };
  /// A program that runs.
  struct Frame {
    Kind kind = Kind::Subprogram;
    std::size_t program = 0;
    Spot begin{};  ///< where it begins, each time
    Spot back{};   ///< of the caller
    int more_times = 0;
    Variables::Locals given{};
    std::optional<int> label{};        ///< of M97
    std::vector<std::size_t> loops{};  ///< that it is in, the innermost last
  };
  /// G66: what behind each move is called. Its variables stay from call to call.
  struct ModalCall {
    std::size_t program = 0;
    int times = 1;
    Variables::Locals locals{};
    std::size_t frame = 0;  ///< by which G66 was given
  };

  void read_line();
  [[nodiscard]] bool carry_out(std::string_view text, std::size_t at);
  void pass_number(std::size_t place);
  void assign(std::string_view text, std::size_t at);
  void carry_out_if(std::string_view text, std::size_t at);
  void begin_loop(std::string_view text, std::size_t at);
  void end_loop(std::size_t place);
  void carry_out_goto(std::string_view text, std::size_t at);
  void go_to(int label, std::size_t place);
  [[nodiscard]] bool call_of_macro(std::string_view text, std::size_t at);
  [[nodiscard]] std::size_t program_of(int number, std::size_t place) const;
  void call_subprogram(const Ordered& ordered);
  /// M97: lines of the same program, to M99.
  void call_local(const Ordered& ordered);
  void call_macro(const MacroCall& call);
  void enter(Frame frame, int times, std::size_t place);
  void return_from(const Ordered& ordered);
  [[nodiscard]] bool holds(std::string_view text, std::size_t& at) const;

  std::string_view text_;
  bool block_delete_;
  Outline outline_;
  Variables& variables_;
  const gcode::Modes& modes_;
  gcode::Endless endless_;
  gcode::Line line_;
  Spot here_, next_;  ///< before the line that was come to last, and behind it
  std::size_t words_ = 0, furthest_ = 0;
  int last_label_ = 0;
  bool begun_ = false;  ///< something stood before the number of the main program, or behind it
  std::vector<Frame> frames_;
  std::optional<ModalCall> modal_;
};

}  // namespace rmac::fanuc
