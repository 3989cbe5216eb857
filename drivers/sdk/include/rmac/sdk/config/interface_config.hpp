#pragma once

#include "rmac/motion/error.hpp"
#include "rmac/sdk/config/module_choice.hpp"

namespace rmac::sdk {

/// What a draft says of the interfaces to drives and to digital I/O. Gateway thread only.
class InterfaceConfig {
 public:
  virtual ~InterfaceConfig() = default;

  virtual Expected<> set_control(const ModuleChoice& module) = 0;
  /// Checks that the interface that was chosen exists and takes its parameters.
  virtual Expected<> initialize_control() = 0;
  /// A mechanism without digital I/O names no interface.
  virtual Expected<> set_io(const ModuleChoice& module) = 0;
  virtual Expected<> initialize_io() = 0;
};

}  // namespace rmac::sdk
