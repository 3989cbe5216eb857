#pragma once

#include <memory>
#include <string>

#include "gateway/dynamics/closed_loops.hpp"
#include "gateway/verification/checks/check.hpp"
#include "gateway/verifier/worker.hpp"

namespace rmac::verifier {

/// All modules of a mechanism together, its servo loops on the axis models of its buses, cycled by hand under a watch.
class MachineRig {
 public:
  /// `virtual_mode`: no loop is closed, and setpoints are where the joints are.
  [[nodiscard]] static tl::expected<std::unique_ptr<MachineRig>, CounterExample> assemble(
      const Task& task, const sdk::DeviceObject& device, bool virtual_mode, Watch& watch);

  /// Has the drives come up, and hold where they stand.
  Checked power_up();
  /// One cycle of `command`.
  Checked cycle();
  [[nodiscard]] tl::unexpected<CounterExample> fault(const char* check, std::string what) const;

  [[nodiscard]] ServoCommand& command() noexcept { return loops_->command; }
  [[nodiscard]] double period_s() const noexcept { return period_s_; }
  [[nodiscard]] gateway::Mechanism& mechanism() noexcept { return loops_->mechanism(); }
  [[nodiscard]] const gateway::Mechanism& mechanism() const noexcept { return loops_->mechanism(); }
  [[nodiscard]] const ServoReport& report() const noexcept { return loops_->report(); }

 private:
  MachineRig(std::unique_ptr<gateway::ClosedLoops> loops, double period_s)
      : loops_(std::move(loops)), period_s_(period_s) {}
  [[nodiscard]] tl::unexpected<CounterExample> unstable() const;

  std::unique_ptr<gateway::ClosedLoops> loops_;
  double period_s_;
};

}  // namespace rmac::verifier
