#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "rmac/fieldbus/simulated_part.hpp"
#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::fieldbus {

/// A valve with the switch that shows where it is: the input goes where the output went, some time later.
struct SimulatedValve {
  int output = 0;
  int input = 0;
  bool inverted = false;  ///< the input is on while the output is off
  double delay_s = 0;
};

/// 64 digital inputs, which tests set, and 64 outputs, which tests read, from any thread; and valves between them.
class SimulatedIoInterface : public DigitalIoInterface {
 public:
  SimulatedIoInterface() = default;
  SimulatedIoInterface(const std::vector<SimulatedValve>& valves, double period_s);
  SimulatedIoInterface(const SimulatedProbe& probe, SimulatedPart part) : probe_(probe), part_(std::move(part)) {}

  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override { outputs_ = 0; }
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override;

  void set_inputs(std::uint64_t inputs) noexcept { inputs_ = inputs; }
  [[nodiscard]] std::uint64_t outputs() const noexcept { return outputs_; }
  /// The probe that is wired to the inputs, if any, and what it finds.
  [[nodiscard]] const std::optional<SimulatedProbe>& probe() const noexcept { return probe_; }
  [[nodiscard]] const SimulatedPart& part() const noexcept { return part_; }
  /// The device fails, and works again; outputs fall meanwhile.
  void set_failed(bool failed) noexcept { failed_ = failed; }

 private:
  std::atomic<std::uint64_t> inputs_{0};
  std::atomic<std::uint64_t> outputs_{0};
  std::atomic<bool> failed_{false};

  struct Valve {
    std::uint64_t output = 0, input = 0;
    bool inverted = false;
    std::int64_t delay_cycles = 0;
    bool on = false;               ///< the input
    std::int64_t differs_for = 0;  ///< cycles since the output went elsewhere
  };
  std::vector<Valve> valves_;
  std::optional<SimulatedProbe> probe_;
  SimulatedPart part_;
};

}  // namespace rmac::fieldbus
