#pragma once

#include <vector>

#include "gateway/rmac_cam/cam_tools.hpp"
#include "gateway/servo/cycle_history.hpp"
#include "rmac/sdk/cam/program_flow.hpp"
#include "rmac/sdk/cam/spindle_control.hpp"

namespace rmac::gateway {

/// Commands spindles and the coolant, as the mechanism, the tool in the spindle and the largest speeds in force allow.
/// Gateway thread only.
class CamSpindles final : public sdk::SpindleControl {
 public:
  CamSpindles(const DeviceInForce& device, MotionSupervisor& supervisor, const CycleHistory& history,
              const CamTools& tools)
      : device_(device), supervisor_(supervisor), history_(history), tools_(tools) {}

  /// The mechanism's largest speeds are in force again.
  void mechanism_changed();

  Expected<> set_rpm(int spindle, double rpm) override;
  [[nodiscard]] Expected<double> rpm(int spindle) const override;
  Expected<> set_max_rpm(int spindle, double rpm) override;
  [[nodiscard]] Expected<double> max_rpm(int spindle) const override;
  Expected<> set_coolant(bool on) override;
  Expected<> set_output(const std::string& name, bool on) override;

  /// What a call does when its turn comes, behind all that is queued.
  [[nodiscard]] Expected<Switch::Speed> in_turn(const sdk::SpindleCall& call) const;
  [[nodiscard]] Expected<Switch::Output> in_turn(const sdk::OutputCall& call) const;

  /// The largest speeds in force, one a spindle.
  [[nodiscard]] const std::vector<double>& largest_rpm() const noexcept { return max_rpm_; }
  /// Puts in force again what was before.
  void take_up(const std::vector<double>& largest_rpm) { max_rpm_ = largest_rpm; }

 private:
  [[nodiscard]] Expected<std::size_t> check_rpm(const char* function, int spindle, double rpm) const;
  [[nodiscard]] Expected<> check_not_the_changers(const char* function, const std::string& output) const;
  Expected<> switch_output(const char* function, std::uint64_t bit, bool on);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const CycleHistory& history_;
  const CamTools& tools_;
  std::vector<double> max_rpm_;
};

}  // namespace rmac::gateway
