#include "gateway/rmac_cam/cam_forces.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rmac::gateway {

Expected<> CamForces::set(int joint, double force) {
  constexpr const char* kFunction = "SetJointForce";
  const auto found = device_.find_joint(joint, kFunction);
  if (!found) return tl::unexpected(found.error());
  const sdk::Joint& there = device_.get()->joints[*found];
  if (there.method != ControlMethod::Force || !there.force) {
    return failure(MinorCode::UnsupportedOperation,
                   fmt::format("{}: joint {} ({}) is under {} control; choose DMAC_FORCE_CONTROL with "
                               "SetMechanismJointControlMethod and Apply first",
                               kFunction, joint, there.limits.name,
                               there.method == ControlMethod::Velocity ? "velocity" : "position"));
  }
  const double least = there.force->contact_force, most = there.force->max_force;
  if (!std::isfinite(force) || (force != 0 && !(std::abs(force) >= least && std::abs(force) <= most))) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} must be 0, or {} to {} either way: joint {} tells contact by the one, and stops "
                               "beyond the other",
                               kFunction, force, least, most, there.limits.name));
  }
  if (force != 0 && supervisor_.guarding().on()) {
    return failure(MinorCode::Other,
                   fmt::format("{}: collisions are checked ahead, and where joint {} goes for its force is not known "
                               "ahead; switch the check off with SetCollisionCheck first",
                               kFunction, there.limits.name));
  }
  const CycleState state = supervisor_.state();
  if (force != 0 && is_faulted(state)) {
    return failure(MinorCode::Other,
                   fmt::format("{}: the machine is {}; remove the cause, then reset", kFunction, to_string(state)));
  }
  auto free = force == 0 ? Expected<>{} : supervisor_.operating().require_free(kFunction);
  return free.map([&] { supervisor_.wish([&](ServoWishes& wishes) { wishes.force[*found] = force; }); });
}

void CamForces::let_go() {
  supervisor_.wish([](ServoWishes& wishes) { wishes.force.fill(0); });
}

}  // namespace rmac::gateway
