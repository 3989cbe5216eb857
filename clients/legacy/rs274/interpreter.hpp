#pragma once

#include <optional>
#include <string>

#include "clients/legacy/rs274/drilling.hpp"
#include "clients/legacy/rs274/motions.hpp"
#include "clients/legacy/rs274/splines.hpp"
#include "clients/legacy/rs274/switches.hpp"

namespace rmac::rs274 {

/// Carries out blocks, each in the order that the report's table gives to what stands in it.
class Interpreter {
 public:
  Interpreter(const Options& options, Writer& writer);
  Interpreter(const Interpreter&) = delete;
  Interpreter& operator=(const Interpreter&) = delete;

  /// Throws a Refusal. False where the program ends.
  [[nodiscard]] bool execute(const Line& line);
  /// Refuses an end of the program within what has to be ended first.
  void require_closed(std::size_t place) const { splines_.require_closed(place); }

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
  [[nodiscard]] std::optional<double> control_parameter(int number) const;

  const Options& options_;
  Writer& writer_;
  Parameters parameters_;
  Block block_;
  Modes modes_;
  Coordinates coordinates_;
  Mover mover_;
  Motions motions_;
  Splines splines_;
  Switches switches_;
  Drilling drilling_;
  std::string message_, block_comment_;
};

}  // namespace rmac::rs274
