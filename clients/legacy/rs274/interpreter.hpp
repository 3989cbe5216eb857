#pragma once

#include <optional>
#include <string>

#include "clients/legacy/rs274/compensation_words.hpp"
#include "clients/legacy/rs274/drilling.hpp"
#include "clients/legacy/rs274/motions.hpp"
#include "clients/legacy/rs274/splines.hpp"
#include "clients/legacy/rs274/switches.hpp"

namespace rmac::rs274 {

/// What comes behind a block: the next one, the end of the program, or a numbered program that M98 calls or M99 ends.
struct After {
  enum class What { Next, End, Call, EndOfNumbered };
  What what = What::Next;
  int label = 0, times = 1;  ///< of a call
  std::size_t place = 0;     ///< of what asks for it
};

/// Carries out blocks, each in the order that the report's table gives to what stands in it.
class Interpreter {
 public:
  Interpreter(const Options& options, Writer& writer, Parameters& parameters);
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Throws a Refusal.
  [[nodiscard]] After execute(const Line& line);
  /// The program ends here. Refused within what has to be ended first.
  void end(std::size_t place) {
    splines_.require_closed(place);
    compensation_.end(place);
  }

 private:
  void read_comments(const Line& line);
  void set_speeds();
  void set_tool();
  void dwell();
  void set_plane_and_units();
  void set_length();
  void set_control();
  void set_distances();
  void act_once();
  void move();
  void move_by(int code, std::size_t place);
  [[nodiscard]] bool stop();
  [[nodiscard]] After numbered_program(const Code& code);
  [[nodiscard]] std::optional<double> control_parameter(int number) const;

  const Options& options_;
  Writer& writer_;
  Parameters& parameters_;
  Block block_;
  Modes modes_;
  Coordinates coordinates_;
  Mover mover_;
  Compensation compensation_;
  Motions motions_;
  Splines splines_;
  Switches switches_;
  Drilling drilling_;
  std::string message_, block_comment_;
};

}  // namespace rmac::rs274
