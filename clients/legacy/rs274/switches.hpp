#pragma once

#include <optional>
#include <string>

#include "clients/legacy/rs274/modes.hpp"

namespace rmac::rs274 {

/// Spindle, coolant and tool: what a program switches between its moves.
class Switches {
 public:
  explicit Switches(Writer& writer) : writer_(writer) {}

  void set_speed(const Word& word);
  void select_tool(const Word& word);
  /// M6. The appliance stops spindle and coolant for it; the report has the coolant flow on.
  void change_tool(std::size_t place);
  /// M3, M4, M5.
  void turn_spindle(int code);
  [[nodiscard]] bool spindle_turns() const noexcept { return direction_ != 0 && rpm_ != 0; }
  /// Stops the spindle where a program does not say so, and lets it turn again.
  void hold_spindle();
  void release_spindle();
  /// M7, M8, M9 of one block.
  void switch_coolant(const Block& block);
  /// Writes what of them the block changed. Several calls are one request.
  void write();
  /// The end of the program: all off.
  void off();

  [[nodiscard]] std::optional<int> tool() const noexcept { return tool_; }
  [[nodiscard]] double rpm() const noexcept { return rpm_; }

 private:
  Writer& writer_;
  std::optional<int> selected_, tool_;
  double rpm_ = 0, turning_rpm_ = 0;
  int direction_ = 0, held_ = 0;                                            ///< 1: clockwise
  bool mist_ = false, flood_ = false, mist_on_ = false, flood_on_ = false;  ///< wanted, and written
};

}  // namespace rmac::rs274
