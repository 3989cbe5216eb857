#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_report.hpp"

namespace rmac::gateway {

/// A mechanism's servo loops as they run on its machine, on buses of their own: with a device that was put on the
/// models of its axes (`put_on_models`) no drive is touched. Inputs and outputs are left out: their device may not be
/// here. Cycled by hand. One thread.
class ClosedLoops {
 public:
  struct Options {
    double period_s = 0.001;
    bool virtual_mode = false;                ///< no loop is closed, and setpoints are where the joints are
    std::function<void()> before_cycle = {};  ///< may be empty
  };
  [[nodiscard]] static Expected<std::unique_ptr<ClosedLoops>> assemble(const sdk::DeviceObject& device,
                                                                       const Options& options,
                                                                       const ModuleLoader& loader);

  /// Has the drives come up, and hold where they stand. An error where they do not within 20 s, or fail.
  [[nodiscard]] Expected<> power_up();
  /// One cycle of `command`. False once there is a fault, which the report has.
  bool cycle();
  /// The fault that the report has, in words.
  [[nodiscard]] std::string fault_text() const;

  [[nodiscard]] Mechanism& mechanism() noexcept { return *mechanism_; }
  [[nodiscard]] const Mechanism& mechanism() const noexcept { return *mechanism_; }
  [[nodiscard]] const ServoReport& report() const noexcept { return report_; }
  [[nodiscard]] std::int64_t cycles() const noexcept { return cycles_; }

  ServoCommand command;

 private:
  explicit ClosedLoops(Options options) : options_(std::move(options)) {}
  void hold_still();

  Options options_;
  BusRegistry registry_;
  std::shared_ptr<Mechanism> mechanism_;
  ServoReport report_;
  std::int64_t cycles_ = 0;
};

}  // namespace rmac::gateway
