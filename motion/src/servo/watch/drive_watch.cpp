#include "servo/watch/drive_watch.hpp"

#include "rmac/motion/drive_power.hpp"

namespace rmac {

namespace {

/// CiA 402's error codes 73xxh: the drive's own encoder or resolver.
bool reports_sensor(std::uint16_t error_code) noexcept {
  return (error_code & 0xFF00U) == 0x7300U;
}

}  // namespace

bool is_faulted(const DriveFeedback& words) noexcept {
  const DriveState state = drive_state(words.statusword);
  return state == DriveState::Fault || state == DriveState::FaultReactionActive;
}

bool operates(const DriveFeedback& words) noexcept {
  return words.online && drive_state(words.statusword) == DriveState::OperationEnabled;
}

void watch_drive(const DriveFeedback& words, bool in_use, ServoFault::Part part, std::size_t index,
                 FaultSink& faults) noexcept {
  const auto number = static_cast<std::uint32_t>(index);
  if (in_use && !words.online) {
    faults.raise({ServoFault::Kind::DriveOffline, part, number, 0, 0});
  } else if (words.online && is_faulted(words)) {
    const auto kind = reports_sensor(words.error_code) ? ServoFault::Kind::SensorLost : ServoFault::Kind::DriveFault;
    faults.raise({kind, part, number, static_cast<double>(words.error_code), 0});
  } else if (in_use && drive_state(words.statusword) != DriveState::OperationEnabled) {
    faults.raise({ServoFault::Kind::DriveDropped, part, number, static_cast<double>(words.statusword), 0});
  }
}

void watch_enabled(const DriveFeedback& words, double timeout_s, ServoFault::Part part, std::size_t index,
                   FaultSink& faults) noexcept {
  if (operates(words)) return;
  const auto kind = words.online ? ServoFault::Kind::EnableTimeout : ServoFault::Kind::DriveOffline;
  faults.raise({kind, part, static_cast<std::uint32_t>(index), static_cast<double>(words.statusword), timeout_s});
}

}  // namespace rmac
