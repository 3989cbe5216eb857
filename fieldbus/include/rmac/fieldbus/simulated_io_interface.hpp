#pragma once

#include <atomic>

#include "rmac/motion/ports/digital_io_interface.hpp"

namespace rmac::fieldbus {

/// 64 digital inputs, which tests set, and 64 outputs, which tests read, from any thread.
class SimulatedIoInterface : public DigitalIoInterface {
 public:
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override { outputs_ = 0; }
  [[nodiscard]] bool exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept override;

  void set_inputs(std::uint64_t inputs) noexcept { inputs_ = inputs; }
  [[nodiscard]] std::uint64_t outputs() const noexcept { return outputs_; }
  /// The device fails, and works again; outputs fall meanwhile.
  void set_failed(bool failed) noexcept { failed_ = failed; }

 private:
  std::atomic<std::uint64_t> inputs_{0};
  std::atomic<std::uint64_t> outputs_{0};
  std::atomic<bool> failed_{false};
};

}  // namespace rmac::fieldbus
