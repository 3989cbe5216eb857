#pragma once

#include <string_view>

#include "clients/legacy/fanuc/blocks/variables.hpp"
#include "clients/legacy/fanuc/flow/flow.hpp"
#include "clients/legacy/gcode/interpreter.hpp"

namespace rmac::fanuc {

/// Variables of the system whose meaning a program's own words make known: #3000 and #3006, #4001 and on (codes that
/// are in force), #5001 to #5003 and #5041 to #5043 (where the tool is), #5021 and #5022 (that in the
/// machine). All others are refused by what they are.
class SystemVariables {
 public:
  SystemVariables(const gcode::Rules& rules, gcode::Interpreter& interpreter, const Flow& flow)
      : rules_(rules), interpreter_(interpreter), flow_(flow) {}

  [[nodiscard]] gcode::Maybe read(int number, std::size_t place) const;
  void write(int number, gcode::Maybe value, std::string_view message, std::size_t place);

 private:
  [[nodiscard]] gcode::Maybe code_in_force(int number) const;
  /// Where the tool is, in the unit in force: in the coordinates of the program, and X and Y in those of the machine.
  [[nodiscard]] gcode::Maybe tip(std::size_t axis, int number, std::size_t place) const;
  [[nodiscard]] gcode::Maybe machine_tip(std::size_t axis, int number, std::size_t place) const;

  const gcode::Rules& rules_;
  gcode::Interpreter& interpreter_;
  const Flow& flow_;
};

}  // namespace rmac::fanuc
