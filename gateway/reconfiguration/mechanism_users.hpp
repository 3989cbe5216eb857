#pragma once

#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// Those who live off the mechanism in force, and are told when it changes. Gateway thread.
class MechanismUsers {
 public:
  MechanismUsers() = default;
  MechanismUsers(const MechanismUsers&) = delete;
  MechanismUsers& operator=(const MechanismUsers&) = delete;
  virtual ~MechanismUsers() = default;

  /// This device object is in force from now on, or none; what was told before is gone when this returns. `fresh`:
  /// another mechanism, so that everything starts anew.
  virtual void mechanism_changed(const sdk::DeviceObject* device, bool fresh) = 0;
  /// The change is through: what was drafted and not applied is dropped.
  virtual void draft_from(const sdk::DeviceObject* device) = 0;
  /// What is in the spindle is to be written down: the tool table is about to be read, or another's comes.
  virtual void keep_mounted() = 0;
};

}  // namespace rmac::gateway
