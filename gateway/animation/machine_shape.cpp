#include "gateway/animation/machine_shape.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/bodies/link.hpp"

namespace rmac::gateway {

void MachineShape::mechanism_changed(const sdk::DeviceObject* device, std::shared_ptr<const Kinematics> kinematics,
                                     std::int64_t cycle) {
  const std::lock_guard held(lock_);
  const std::string machine = device == nullptr ? "" : device->name;
  // A machine that comes back after a reset, or with other laws, stands where it stood.
  if (machine == machine_ && kinematics == kinematics_) return;
  ++number_;
  cycle_ = cycle;
  machine_ = machine;
  kinematics_ = std::move(kinematics);
  joints_.clear();
  if (device != nullptr) {
    for (const sdk::Joint& joint : device->joints) joints_.push_back(joint.limits);
  }
  drawing_.reset();
}

void MachineShape::set_bodies(MachineBodies bodies) {
  const std::lock_guard held(lock_);
  ++number_;
  bodies_ = std::make_shared<const MachineBodies>(std::move(bodies));
  drawing_.reset();
}

std::shared_ptr<const MachineBodies> MachineShape::bodies() const {
  const std::lock_guard held(lock_);
  return bodies_;
}

std::shared_ptr<const MachineDrawing> MachineShape::drawing() const {
  const std::lock_guard held(lock_);
  if (drawing_ == nullptr) drawing_ = std::make_shared<const MachineDrawing>(draw());
  return drawing_;
}

MachineDrawing MachineShape::draw() const {
  MachineDrawing made;
  made.number = number_;
  made.after_cycle = cycle_;
  made.machine = machine_;
  if (machine_.empty() || kinematics_ == nullptr) {
    made.missing = "no machine is loaded; load one with Device.Load";
    return made;
  }
  for (const JointLimits& joint : joints_) made.joints.push_back(joint.name);
  const std::vector<std::string>& chain = bodies_->chain;
  if (chain.empty()) {
    made.missing = fmt::format(
        "nothing is known of the links of {}: the device.json of its machine has no Chain and no Geometry", machine_);
    return made;
  }
  std::vector<std::string> wanted = made.joints;
  wanted.emplace_back(kBase);
  if (!std::ranges::is_permutation(chain, wanted)) {
    made.missing =
        fmt::format("the joints of {} are not those of the Chain that it was loaded with; load it anew", machine_);
    return made;
  }
  auto links = LinkChain::make(*kinematics_, chain, joints_);
  if (!links) {
    made.missing = fmt::format("where the links of {} stand is not known: {}", machine_, links.error().message);
    return made;
  }
  made.links.emplace(std::move(*links), chain);
  made.bodies = bodies_;
  if (bodies_->bodies.empty()) {
    made.missing = fmt::format(
        "where the links of {} stand is known, and not what they look like: the device.json of its machine has no "
        "Geometry",
        machine_);
  }
  return made;
}

}  // namespace rmac::gateway
