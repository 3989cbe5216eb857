#pragma once

#include <string>
#include <vector>

#include "gateway/buses/bus_registry.hpp"
#include "gateway/mechanism/mechanism.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"

namespace rmac::fault_test {

/// How a joint hangs on its motor, which is alone with it.
struct JointDrive {
  std::size_t axis = 0;      ///< of the bus
  double mm_per_rad = 0;     ///< or degrees
  double nm_per_effort = 0;  ///< N·m of the shaft for a N, or N·m, of the joint
  double max_following_error = 0;
  double max_effort = 0;
};

/// A machine of the tree as the appliance assembles it from its device.json, with the axes that this says it has.
class TreeMachine {
 public:
  explicit TreeMachine(const std::string& folder);  ///< under drivers/

  [[nodiscard]] const std::string& folder() const { return folder_; }
  [[nodiscard]] const sdk::DeviceObject& device() const { return mechanism_->device; }
  /// What its loop is made of; the bus is to be replaced.
  [[nodiscard]] const ServoLoopParts& parts() const { return mechanism_->loop->parts(); }
  [[nodiscard]] const std::vector<fieldbus::SimulatedAxis>& axes() const { return axes_; }
  [[nodiscard]] int answer_delay() const { return answer_delay_; }
  [[nodiscard]] JointDrive drive_of(std::size_t joint) const;

 private:
  std::string folder_;
  std::vector<fieldbus::SimulatedAxis> axes_;
  int answer_delay_ = 0;
  gateway::BusRegistry registry_;
  std::shared_ptr<gateway::Mechanism> mechanism_;
};

}  // namespace rmac::fault_test
