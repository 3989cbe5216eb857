#include <algorithm>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

ServoHandover ServoLoop::Impl::handover() const noexcept {
  ServoHandover result;
  result.count = wiring.actuators();
  std::array<double, kMaxJoints> shaft_set{};
  transmission.shafts_for(setpoints.positions(), {shaft_set.data(), wiring.actuators()});
  const IndexSet under_control = state.driving() && !parts.virtual_mode ? controlled() : 0;
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    const ServoActuator& part = parts.actuators[i];
    const int sense = part.scale.direction * wiring.sense(i);
    const PositionWatch::Known known = positions.known(i);
    result.drives[i] = {.bus = part.bus.get(),
                        .axis = part.axis,
                        .counts = shafts[i].counts(),
                        .setpoint_counts = shaft_counts(part.scale, shaft_set[i]),
                        .torque_nm = part.scale.direction * torques[i],
                        .backlash_side = sense * transmission.correction(wiring.joint_of(i)).side(),
                        .beside = gantries.beside(i),
                        .live = has(under_control, i),
                        .seen = shafts[i].seen(),
                        .believed = known.believed,
                        .referenced = known.referenced,
                        .reference_lost = known.lost};
  }
  return result;
}

void ServoLoop::Impl::take_over(const ServoHandover& previous) noexcept {
  IndexSet live_drives = 0;
  std::size_t known = 0;
  std::array<double, kMaxJoints> shaft_set{};
  const std::span<const ServoHandover::Drive> drives(previous.drives.data(), previous.count);
  for (std::size_t i = 0; i < wiring.actuators(); ++i) {
    const ServoActuator& part = parts.actuators[i];
    const auto found = std::find_if(drives.begin(), drives.end(), [&part](const ServoHandover::Drive& drive) {
      return drive.bus == part.bus.get() && drive.axis == part.axis;
    });
    if (found == drives.end()) continue;
    ++known;
    shafts[i].take_over(found->counts, found->seen);
    positions.take_over(i, {found->believed, found->referenced, found->reference_lost}, found->live);
    torques.take_over(i, part.scale.direction * found->torque_nm);
    if (found->beside) gantries.take_over(i, *found->beside);
    shaft_set[i] = shaft_rad(part.scale, found->setpoint_counts);
    if (const int sense = part.scale.direction * wiring.sense(i); sense != 0) {
      transmission.correction(wiring.joint_of(i)).set_side(sense * found->backlash_side);
    }
    if (found->live) live_drives |= only(i);
  }
  positions.go_on_from(shafts);
  const std::span<const double> shaft_span(shaft_set.data(), wiring.actuators());
  if (!parts.virtual_mode) {
    exchange.take_over();
    if (live_drives != 0) take_over_joints(live_drives, shaft_span);
  } else if (known == wiring.actuators()) {
    std::array<double, kMaxJoints> at{};
    transmission.joints_for(shaft_span, {at.data(), wiring.joints()});
    setpoints.hold_at(at);
    joints.reflect(setpoints.position(), joints.velocity());
  }
}

void ServoLoop::Impl::take_over_joints(IndexSet live_drives, std::span<const double> shaft_set) noexcept {
  state.take_over();
  std::array<double, kMaxJoints> at{}, effort{};
  transmission.joints_for(shaft_set, {at.data(), wiring.joints()});
  setpoints.hold_at(at);
  transmission.efforts_for(setpoints.positions(), torques.all(), {effort.data(), wiring.joints()});
  IndexSet handed = 0;
  for (std::size_t j = 0; j < wiring.joints(); ++j) {
    if ((wiring.actuators_of(j) & ~live_drives) != 0) continue;
    handed |= only(j);
    laws.take_over(j, effort[j]);
  }
  live.take_over(handed);
}

}  // namespace rmac
