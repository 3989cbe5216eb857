#pragma once

#include <mutex>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// What of a mechanism was verified: its database, and drafts since. Nothing beyond it is put in force. Any thread.
class VerifiedDevices {
 public:
  /// Another mechanism, or the same anew, which was verified as its database has it.
  void begin(const sdk::DeviceObject& database);
  /// A draft passed, too; forgotten where it is one of another mechanism.
  void add(sdk::DeviceObject draft);
  /// Refuses what goes beyond all of it, and says how it goes beyond the database. Travel, speed, acceleration and jerk
  /// of a joint that the database has stay within it, for no verification sees where a slide ends.
  [[nodiscard]] Expected<> admit(const sdk::DeviceObject& wanted) const;
  /// Whether it would be admitted once it is verified.
  [[nodiscard]] bool lacks_verification(const sdk::DeviceObject& wanted) const;

 private:
  mutable std::mutex mutex_;
  std::vector<sdk::DeviceObject> verified_;
};

}  // namespace rmac::gateway
