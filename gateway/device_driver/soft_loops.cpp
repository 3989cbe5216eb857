#include "gateway/device_driver/soft_loops.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::gateway {
namespace {

bool begins_with_pid(const sdk::Joint& joint) {
  return !joint.servo_law.name.empty() && (joint.gains.size() == 3 || joint.gains.size() == 7);
}

void soften(sdk::Joint& joint, double factor) {
  joint.gains[0] /= factor;
  joint.gains[1] /= factor * factor;
  joint.gains[2] /= factor;
  if (joint.gantry) {
    joint.gantry->stiffness /= factor;
    joint.gantry->damping /= factor;
  }
  // Three times the mass that the gains were made for then lags no more than that mass did.
  constexpr double kShareOfAcceleration = 0.25;
  joint.limits.max_acceleration *= kShareOfAcceleration;
  // A spring that is 8 times softer pushes half as hard at this bound as the one before did at its own.
  constexpr double kTimesAsFar = 4, kFar = 10;
  const double wider = std::clamp(factor / 2, 1.0, kTimesAsFar) * joint.max_following_error;
  joint.max_following_error = std::max(joint.max_following_error, std::min(kFar, wider));
}

}  // namespace

Expected<sdk::DeviceObject> softened(const sdk::DeviceObject& device, double factor) {
  if (device.overlay) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("Soften: {} lies over another machine, and has its loops; load that one so", device.name));
  }
  sdk::DeviceObject made = device;
  bool any = false;
  for (auto* const joints : {&made.joints, &made.held_joints}) {
    for (sdk::Joint& joint : *joints) {
      if (!begins_with_pid(joint)) continue;
      soften(joint, factor);
      any = true;
    }
  }
  if (any) return made;
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("Soften: no joint of {} has a PID, alone or ahead of feedforward", device.name));
}

}  // namespace rmac::gateway
