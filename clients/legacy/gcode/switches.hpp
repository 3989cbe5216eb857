#pragma once

#include <optional>
#include <set>
#include <string>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/program/machine_switches.hpp"

namespace rmac::gcode {

/// Spindle, coolant and tool: what a program switches between its moves.
class Switches {
 public:
  explicit Switches(Writer& writer) : writer_(writer), machine_(writer) {}

  void set_speed(const Word& word);
  [[nodiscard]] bool speed_is_set() const noexcept { return speed_is_set_; }
  void select_tool(const Word& word);
  /// M6. The appliance stops spindle and coolant for it; the report has the coolant flow on.
  void change_tool(std::size_t place);
  /// M3, M4, M5.
  void turn_spindle(int code);
  [[nodiscard]] bool spindle_turns() const noexcept { return machine_.spindle_turns(); }
  /// Stops the spindle where a program does not say so, and lets it turn again.
  void hold_spindle() { machine_.hold_spindle(); }
  void release_spindle() { machine_.release_spindle(); }
  /// M7, M8, M9 of one block.
  void switch_coolant(const Block& block);
  /// Writes what of them the block changed. Several calls are one request.
  void write() { machine_.write(); }
  /// Outputs of the machine beside those: on until a stop, a change of tool or the end at the latest.
  void switch_output(const std::string& name, bool on);
  /// Coolant of all kinds off, and those outputs.
  void stop_coolant();
  /// The end of the program: all off.
  void off();

  [[nodiscard]] std::optional<int> tool() const noexcept { return tool_; }
  /// The last T.
  [[nodiscard]] std::optional<int> selected() const noexcept { return selected_; }
  /// Of the spindle, as of MachineSwitches.
  [[nodiscard]] int direction() const noexcept { return machine_.direction(); }
  [[nodiscard]] bool mist() const noexcept { return machine_.mist(); }
  [[nodiscard]] bool flood() const noexcept { return machine_.flood(); }
  [[nodiscard]] double rpm() const noexcept { return machine_.rpm(); }

  /// Of spindle and coolant.
  struct State {
    int direction = 0;
    double rpm = 0;
    bool speed_is_set = false, mist = false, flood = false;
  };
  [[nodiscard]] State state() const noexcept { return {direction(), rpm(), speed_is_set_, mist(), flood()}; }
  void restore(const State& saved);

 private:
  void outputs_off();

  Writer& writer_;
  legacy::MachineSwitches machine_;
  std::set<std::string> outputs_on_;
  std::optional<int> selected_, tool_;
  bool speed_is_set_ = false;
};

}  // namespace rmac::gcode
