#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "clients/legacy/gcode/blocks/line.hpp"
#include "clients/legacy/gcode/compensation_words.hpp"
#include "clients/legacy/gcode/drilling.hpp"
#include "clients/legacy/gcode/modes/doubts.hpp"
#include "clients/legacy/gcode/motions.hpp"
#include "clients/legacy/gcode/splines.hpp"
#include "clients/legacy/gcode/switches.hpp"
#include "clients/legacy/gcode/tool_axis.hpp"
#include "clients/legacy/gcode/turning.hpp"

namespace rmac::gcode {

/// What comes behind a block: the next one, the end of the program, a numbered program that M98 calls or M99 ends, or
/// M70 to M73, which save what holds or restore it.
struct After {
  enum class What { Next, End, Call, EndOfNumbered, Modes };
  What what = What::Next;
  int label = 0, times = 1;  ///< of a call; the former the code of Modes
  std::size_t place = 0;     ///< of what asks for it
};

/// What M70 and M73 save.
struct State {
  Modes modes;
  std::size_t system = 0;
  std::optional<double> tolerance_mm;  ///< as in Interpreter
  Switches::State switches;
};

/// Throws a Refusal where M0, M1, M2, M5, M9 or M30 stands beside `what`, which would be carried out behind it.
void require_nothing_behind(const Block& block, std::string_view what);

/// Carries out blocks, each in the order that the report's table gives to what stands in it.
class Interpreter {
 public:
  Interpreter(const Options& options, const Rules& rules, Writer& writer);
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// `line`: what the block was read from. Throws a Refusal.
  [[nodiscard]] After execute(Block& block, const Line& line);
  /// The program ends here, and spindle, coolant and outputs are off, as by M2. Refused within what has to be ended
  /// first.
  void end() {
    splines_.require_closed(0);
    compensation_.end(0);
    switches_.off();
  }

  /// A stop of the program that is no code of a block. `optional`: as M1.
  void stop(bool optional, std::string_view message);
  /// Switches an output of the machine, where it is not so already: a stop, a change of tool and the end switch it off.
  void switch_output(const std::string& name, bool on) { switches_.switch_output(name, on); }

  /// Where the tool is in X and Y the program leaves open from now on, until it names both. `why` outlives it.
  void leave_place_open(std::string_view why) { doubts_.leave_open(why); }
  [[nodiscard]] const Doubts& doubts() const { return doubts_; }

  /// What holds, but for what moves are, and so that it holds again. Both throw a Refusal.
  [[nodiscard]] State state(std::size_t place) const;
  void restore(const State& saved, std::size_t place);

  /// Throws a Refusal while moves are held back, or the tool is beside a contour.
  void require_no_contour(std::size_t place) const;

  /// What holds behind the last block, where programs ask for it.
  [[nodiscard]] const Modes& modes() const noexcept { return modes_; }
  [[nodiscard]] const Coordinates& coordinates() const noexcept { return coordinates_; }
  [[nodiscard]] const Switches& switches() const noexcept { return switches_; }
  /// Where the program believes the tool to be, in its own unit; none where that is not known, or beside a contour.
  [[nodiscard]] std::optional<double> tip(std::size_t axis) const;

 private:
  void read_comments(const Line& line);
  void set_speeds(Block& block);
  void set_tool(Block& block);
  [[nodiscard]] bool switches_off_behind(const Block& block) const;
  void switch_off_behind_motion(const Block& block);
  void dwell(Block& block);
  void set_plane_and_units(Block& block);
  void set_length(Block& block);
  void set_control(Block& block);
  void set_distances(Block& block);
  void act_once(Block& block);
  void move(Block& block);
  void move_by(Block& block, int code, std::size_t place);
  [[nodiscard]] bool stop(const Block& block);
  [[nodiscard]] After numbered_program(Block& block, const Code& code);
  void set_path_tolerance(double mm);

  const Options& options_;
  const Rules& rules_;
  Writer& writer_;
  Modes modes_;
  Coordinates coordinates_;
  Mover mover_;
  Compensation compensation_;
  Motions motions_;
  Doubts doubts_;
  Turning turning_;
  ToolAxis tool_axis_;
  Splines splines_;
  Switches switches_;
  Drilling drilling_;
  std::string message_, block_comment_;
  std::optional<double> tolerance_mm_;  ///< of the path, where the program said it; 0 of G61
};

}  // namespace rmac::gcode
