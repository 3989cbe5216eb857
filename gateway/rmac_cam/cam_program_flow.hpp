#pragma once

#include "gateway/cycle/motion_supervisor.hpp"
#include "gateway/rmac_cam/cam_spindles.hpp"
#include "rmac/sdk/cam/program_flow.hpp"

namespace rmac::gateway {

/// Queues what a program does between its moves, as far as the mechanism can do it. Gateway thread only.
class CamProgramFlow final : public sdk::ProgramFlow {
 public:
  CamProgramFlow(const DeviceInForce& device, MotionSupervisor& supervisor, const CamSpindles& spindles)
      : device_(device), supervisor_(supervisor), spindles_(spindles) {}

  Expected<> dwell(std::int64_t id, double time_s) override;
  Expected<> stop(std::int64_t id, bool optional, const std::string& message) override;
  Expected<> await_input(std::int64_t id, const std::string& name, bool on, double timeout_s) override;
  Expected<> in_turn(std::int64_t id, const std::vector<sdk::CallInTurn>& calls) override;
  void set_optional_stops(bool on) override { supervisor_.operating().set_optional_stops(on); }
  [[nodiscard]] bool optional_stops() const override { return supervisor_.now().optional_stops; }

  /// Queues what was queued before, on the mechanism in force now.
  [[nodiscard]] Expected<> queue_again(const InTurn& turn);

 private:
  [[nodiscard]] Expected<> add(const char* function, InTurn turn);

  const DeviceInForce& device_;
  MotionSupervisor& supervisor_;
  const CamSpindles& spindles_;
};

}  // namespace rmac::gateway
