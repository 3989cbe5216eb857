#include <Eigen/Dense>
#include <algorithm>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

// Sizes are bounded at compile time, so Eigen keeps these on the stack.
constexpr int kMax = static_cast<int>(kMaxJoints);
using EffortMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMax, kMax>;
using EffortVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMax, 1>;

/// Joint efforts that give these shaft torques: the map's efforts are linear, so its unit responses are its matrix.
void joint_efforts(const ActuatorMap& map, std::span<const double> joints, std::span<const double> torques,
                   std::span<double> efforts) noexcept {
  EffortMatrix matrix(torques.size(), efforts.size());
  for (std::size_t j = 0; j < efforts.size(); ++j) {
    std::array<double, kMaxJoints> unit{};
    unit[j] = 1;
    map.actuator_efforts(joints, {unit.data(), efforts.size()},
                         {&matrix(0, static_cast<Eigen::Index>(j)), torques.size()});
  }
  const Eigen::Map<const EffortVector> right(torques.data(), static_cast<Eigen::Index>(torques.size()));
  const EffortVector solved = matrix.colPivHouseholderQr().solve(right);
  std::copy_n(solved.data(), efforts.size(), efforts.data());
}

}  // namespace

void ServoLoop::Impl::shafts_for(std::span<const double> joint_positions, std::span<double> shafts) const noexcept {
  std::array<double, kMaxJoints> shown{};
  for (std::size_t j = 0; j < axes; ++j) shown[j] = corrections[j].shown(joint_positions[j]);
  parts.actuator_map->actuator_positions({shown.data(), axes}, shafts);
}

void ServoLoop::Impl::joints_for(std::span<const double> shafts, std::span<double> joint_positions) const noexcept {
  parts.actuator_map->joint_positions(shafts, joint_positions);
  for (std::size_t j = 0; j < axes; ++j) joint_positions[j] = corrections[j].actual(joint_positions[j]);
}

ServoHandover ServoLoop::handover() const noexcept {
  const Impl& loop = *impl_;
  ServoHandover result;
  result.count = loop.actuators;
  std::array<double, kMaxJoints> shaft_set{};
  loop.shafts_for(hold_position(), {shaft_set.data(), loop.actuators});
  for (std::size_t i = 0; i < loop.actuators; ++i) {
    const ServoActuator& part = loop.parts.actuators[i];
    const bool live = loop.driving() && !loop.parts.virtual_mode && loop.controlled(i);
    result.drives[i] = {
        .bus = part.bus.get(),
        .axis = part.axis,
        .counts = loop.counts[i],
        .setpoint_counts = loop.shaft_counts(i, shaft_set[i]),
        .torque_nm = part.scale.direction * loop.torque[i],
        .backlash_side = part.scale.direction * loop.sense[i] * loop.corrections[loop.joint_of[i]].side(),
        .live = live,
        .seen = loop.seen[i]};
  }
  return result;
}

void ServoLoop::engage(const ServoHandover& previous) noexcept {
  Impl& loop = *impl_;
  std::uint32_t live_drives = 0;
  std::size_t known = 0;
  std::array<double, kMaxJoints> shaft_set{};
  const std::span<const ServoHandover::Drive> drives(previous.drives.data(), previous.count);
  for (std::size_t i = 0; i < loop.actuators; ++i) {
    const ServoActuator& part = loop.parts.actuators[i];
    const auto found = std::find_if(drives.begin(), drives.end(), [&part](const ServoHandover::Drive& drive) {
      return drive.bus == part.bus.get() && drive.axis == part.axis;
    });
    if (found == drives.end()) continue;
    ++known;
    loop.seen[i] = found->seen;
    loop.history[i] = found->seen ? 1 : 0;
    loop.counts[i] = found->counts;
    loop.shaft[i] = loop.shaft_rad(i, static_cast<double>(found->counts));
    loop.torque[i] = part.scale.direction * found->torque_nm;
    shaft_set[i] = loop.shaft_rad(i, found->setpoint_counts);
    if (loop.sense[i] != 0) {
      loop.corrections[loop.joint_of[i]].set_side(part.scale.direction * loop.sense[i] * found->backlash_side);
    }
    if (found->live) live_drives |= std::uint32_t{1} << i;
  }

  if (loop.parts.virtual_mode) {
    if (known == loop.actuators) {
      loop.joints_for({shaft_set.data(), loop.actuators}, {loop.hold.data(), loop.axes});
      loop.position = loop.hold;
    }
    return;
  }
  for (const auto& bus : loop.buses) {
    for (std::uint32_t axis = 0; axis < bus->commands.size(); ++axis) {
      if (!loop.owns(bus.get(), axis)) bus->commands[axis] = DriveCommand{};
    }
  }
  loop.fresh = false;
  if (live_drives != 0) loop.take_over_joints(live_drives, shaft_set);
}

bool ServoLoop::Impl::owns(const ServoBus* bus, std::uint32_t axis) const noexcept {
  const auto mine = [bus, axis](const auto& part) { return part.bus.get() == bus && part.axis == axis; };
  return std::any_of(parts.actuators.begin(), parts.actuators.end(), mine) ||
         std::any_of(parts.spindles.begin(), parts.spindles.end(), mine);
}

void ServoLoop::Impl::take_over_joints(std::uint32_t live_drives,
                                       const std::array<double, kMaxJoints>& shaft_set) noexcept {
  state = ServoState::Enabling;
  waiting_cycles = 0;
  joints_for({shaft_set.data(), actuators}, {hold.data(), axes});
  joint_efforts(*parts.actuator_map, {hold.data(), axes}, {torque.data(), actuators}, {effort.data(), axes});
  for (std::size_t j = 0; j < axes; ++j) {
    live[j] = handed[j] = (actuators_of[j] & ~live_drives) == 0;
    if (!live[j]) effort[j] = 0;
  }
}

}  // namespace rmac
