#include "gateway/device_driver/soft_loops.hpp"

#include <algorithm>

namespace rmac::gateway {
namespace {

void soften(sdk::Joint& joint, double factor) {
  const bool begins_with_pid = joint.gains.size() == 3 || joint.gains.size() == 7;
  if (joint.servo_law.name.empty() || !begins_with_pid) return;
  joint.gains[0] /= factor;
  joint.gains[1] /= factor * factor;
  joint.gains[2] /= factor;
  // Three times the mass that the gains were made for then lags no more than that mass did.
  constexpr double kShareOfAcceleration = 0.25;
  joint.limits.max_acceleration *= kShareOfAcceleration;
  // A spring that is so much softer pushes half as hard at this bound as the one before did at its own.
  joint.max_following_error *= std::max(1.0, factor / 2);
}

}  // namespace

sdk::DeviceObject softened(const sdk::DeviceObject& device, double factor) {
  sdk::DeviceObject made = device;
  for (sdk::Joint& joint : made.joints) soften(joint, factor);
  for (sdk::Joint& joint : made.held_joints) soften(joint, factor);
  return made;
}

}  // namespace rmac::gateway
