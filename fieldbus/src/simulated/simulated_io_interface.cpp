#include "rmac/fieldbus/simulated_io_interface.hpp"

namespace rmac::fieldbus {

bool SimulatedIoInterface::exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept {
  if (failed_) {
    outputs_ = 0;
    return false;
  }
  outputs_ = outputs;
  inputs = inputs_;
  return true;
}

}  // namespace rmac::fieldbus
