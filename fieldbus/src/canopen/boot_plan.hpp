#pragma once

#include <vector>

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// One step of bringing up a node: an object is read and compared, or written.
struct BootStep {
  enum class Kind : std::uint8_t {
    Check,      ///< (what was read & mask) must be `value`
    Write,      ///< `size` bytes of `value`
    ReadError,  ///< the drive's error code, for whoever asks later
  };
  Kind kind = Kind::Write;
  ObjectAddress object;
  std::uint8_t size = 4;
  std::uint32_t value = 0;
  std::uint32_t mask = 0xFFFFFFFF;
  bool optional = false;  ///< passed over when the node does not have the object
};

/// All steps for `node`, in order: who it is, what it can, its PDOs, its watch over the master, its mode and setup.
[[nodiscard]] std::vector<BootStep> boot_plan(const CanopenConfig& config, std::uint8_t node);

}  // namespace rmac::fieldbus::canopen
