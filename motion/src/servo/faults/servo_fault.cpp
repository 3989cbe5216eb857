#include "rmac/motion/servo/servo_fault.hpp"

namespace rmac {

const char* to_string(ServoState state) noexcept {
  switch (state) {
    case ServoState::Off:
      return "Off";
    case ServoState::Enabling:
      return "Enabling";
    case ServoState::Engaged:
      return "Engaged";
    case ServoState::Homing:
      return "Homing";
    case ServoState::QuickStop:
      return "QuickStop";
    case ServoState::Faulted:
      return "Faulted";
  }
  return "Unknown";
}

const char* to_string(ServoFault::Kind kind) noexcept {
  switch (kind) {
    case ServoFault::Kind::None:
      return "None";
    case ServoFault::Kind::FollowingError:
      return "FollowingError";
    case ServoFault::Kind::VelocityBound:
      return "VelocityBound";
    case ServoFault::Kind::TorqueBound:
      return "TorqueBound";
    case ServoFault::Kind::Oscillation:
      return "Oscillation";
    case ServoFault::Kind::WrongDirection:
      return "WrongDirection";
    case ServoFault::Kind::StandsStill:
      return "StandsStill";
    case ServoFault::Kind::EncoderFrozen:
      return "EncoderFrozen";
    case ServoFault::Kind::Skewed:
      return "Skewed";
    case ServoFault::Kind::EncoderJump:
      return "EncoderJump";
    case ServoFault::Kind::Displaced:
      return "Displaced";
    case ServoFault::Kind::SensorLost:
      return "SensorLost";
    case ServoFault::Kind::ForceLimit:
      return "ForceLimit";
    case ServoFault::Kind::ContactLost:
      return "ContactLost";
    case ServoFault::Kind::CyclesLost:
      return "CyclesLost";
    case ServoFault::Kind::NotANumber:
      return "NotANumber";
    case ServoFault::Kind::DriveFault:
      return "DriveFault";
    case ServoFault::Kind::DriveOffline:
      return "DriveOffline";
    case ServoFault::Kind::DriveDropped:
      return "DriveDropped";
    case ServoFault::Kind::EnableTimeout:
      return "EnableTimeout";
    case ServoFault::Kind::BusFailure:
      return "BusFailure";
    case ServoFault::Kind::IoFailure:
      return "IoFailure";
    case ServoFault::Kind::EmergencyStop:
      return "EmergencyStop";
    case ServoFault::Kind::LimitSwitch:
      return "LimitSwitch";
    case ServoFault::Kind::HomingFailed:
      return "HomingFailed";
  }
  return "Unknown";
}

}  // namespace rmac
