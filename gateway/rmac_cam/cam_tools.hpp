#pragma once

#include "gateway/rmac_cam/tool_change_steps.hpp"
#include "gateway/tools/tool_rack.hpp"

namespace rmac::gateway {

/// The tools of the mechanism in force, their changes, and what the tool in the spindle allows. Gateway thread only;
/// `tools_now` also while another thread uses RMAC_CAM.
class CamTools final : public ToolPort {
 public:
  CamTools(const DeviceInForce& device, MotionSupervisor& supervisor, ToolRack& rack, const MoveMaker& maker)
      : device_(device), supervisor_(supervisor), rack_(rack), steps_(device, maker) {}

  /// `fresh`: it is another mechanism, with the tool in its spindle that its table tells.
  void mechanism_changed(bool fresh);

  [[nodiscard]] Expected<std::vector<Tool>> tools() const override;
  [[nodiscard]] ToolsNow tools_now() const override { return supervisor_.tools_now(); }
  Expected<> set_tool(const Tool& tool) override;
  Expected<> remove_tool(int number) override;
  Expected<> change_tool(int number) override;
  Expected<> confirm_tool(int number) override;

  /// Writes down what is in the spindle now.
  [[nodiscard]] Expected<> keep_mounted();
  /// Refuses a move that the tool in the spindle, or the one that is to be there, cannot make. `feeds`: it cuts.
  [[nodiscard]] Expected<> check_move(std::int64_t move_id, bool feeds) const;
  /// Refuses a speed of the spindle that the tool in it does not bear.
  [[nodiscard]] Expected<> check_speed(double rpm) const;
  /// The same of the tool that is to be in it when all that is queued is done.
  [[nodiscard]] Expected<> check_speed_in_turn(double rpm) const;

 private:
  [[nodiscard]] Expected<Tool> find(int number, const char* function) const;
  /// Refuses a change that is to be automatic and cannot be.
  [[nodiscard]] Expected<> check_changer(const ToolsNow& now) const;
  /// The change to `tool`, which is not there yet; leaves the queue's end where the steps leave the machine.
  [[nodiscard]] Expected<std::vector<QueueStep>> make_change(const ToolsNow& now, const Tool& tool);
  [[nodiscard]] Expected<> check_bears(const char* function, int number, double rpm) const;
  /// The tool is in the spindle now, at rest.
  void put_in_spindle(const Tool& tool);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  ToolRack& rack_;
  ToolChangeSteps steps_;
};

}  // namespace rmac::gateway
