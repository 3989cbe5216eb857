#pragma once

#include <memory>
#include <vector>

#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac {

/// A bus with the words of all its drives. The bus registry owns it; servo loops share it one after the other.
struct ServoBus {
  explicit ServoBus(std::shared_ptr<DigitalControlInterface> bus_interface);
  std::shared_ptr<DigitalControlInterface> interface;
  std::vector<DriveCommand> commands;   ///< go out with the next exchange
  std::vector<DriveFeedback> feedback;  ///< came in with the last
};

}  // namespace rmac
