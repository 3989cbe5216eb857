#include <algorithm>
#include <cmath>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

namespace {

std::string joint_text(std::size_t joint) {
  return "joint " + std::to_string(joint);
}

Expected<> check_counts(const ServoLoopParts& parts) {
  if (!parts.kinematics || !parts.actuator_map) {
    return failure(MinorCode::InvalidParameter, "servo loop: kinematics or actuator map is missing; choose both");
  }
  const std::size_t axes = parts.axes.size();
  const std::size_t joints = parts.kinematics->joint_count();
  if (joints == 0 || joints > axes || axes > kMaxJoints) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the kinematics has " + std::to_string(joints) + " joints, but " + std::to_string(axes) +
                       " joints are configured (held ones included); at least as many as the kinematics has, and at "
                       "most " +
                       std::to_string(kMaxJoints) + ", are needed");
  }
  if (parts.actuator_map->joint_count() != axes) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the actuator map is for " + std::to_string(parts.actuator_map->joint_count()) +
                       " joints, but " + std::to_string(axes) + " are configured (held ones included)");
  }
  if (parts.actuator_map->actuator_count() != parts.actuators.size() || parts.actuators.size() > kMaxJoints) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the actuator map is for " + std::to_string(parts.actuator_map->actuator_count()) +
                       " actuators, but " + std::to_string(parts.actuators.size()) + " are configured");
  }
  if (parts.spindles.size() > kMaxSpindles) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: " + std::to_string(parts.spindles.size()) +
                                                         " spindles; at most " + std::to_string(kMaxSpindles));
  }
  if (!(parts.period_s > 0 && parts.period_s <= 0.1) || !(parts.enable_timeout_s > 0)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: the period must be above 0 and at most 0.1 s, the enable time-out above 0 s");
  }
  return {};
}

Expected<> check_axes(const ServoLoopParts& parts) {
  for (std::size_t j = 0; j < parts.axes.size(); ++j) {
    const ServoAxis& axis = parts.axes[j];
    if (axis.method == ControlMethod::Force) {
      if (auto ok = check_force_control(axis.force, joint_text(j)); !ok) return ok;
      if (!axis.force_sensor && !parts.virtual_mode) {
        return failure(MinorCode::InvalidParameter,
                       "servo loop: " + joint_text(j) + " is under force control and has no force sensor");
      }
    }
    if (!(axis.max_following_error > 0) || !(axis.max_effort > 0) || !std::isfinite(axis.max_effort)) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + joint_text(j) + " needs a following-error bound and an effort bound above 0");
    }
    if (auto ok = check_mechanics(axis.mechanics, parts.period_s, joint_text(j)); !ok) return ok;
  }
  const std::size_t starts = parts.virtual_start.size();
  if (starts != 0 && starts != parts.axes.size()) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: virtual mode starts at " + std::to_string(starts) +
                                                         " positions, but there are " +
                                                         std::to_string(parts.axes.size()) + " joints");
  }
  return {};
}

Expected<> check_drive(const ServoBus* bus, std::uint32_t axis, const std::string& who) {
  if (bus == nullptr) return failure(MinorCode::InvalidParameter, "servo loop: " + who + " has no bus");
  if (axis >= bus->commands.size()) {
    return failure(MinorCode::InvalidParameterValue, "servo loop: " + who + " is axis " + std::to_string(axis) +
                                                         ", but its bus has " + std::to_string(bus->commands.size()) +
                                                         " axes, counted from 0");
  }
  return {};
}

/// A gain that closes more than half of the error within a cycle would swing, with the cycle that an answer takes.
constexpr double kMostOfACycle = 0.5;

Expected<> check_mode(const ServoActuator& actuator, double period_s, const std::string& who) {
  const bool velocity = actuator.mode == DriveMode::CyclicSyncVelocity;
  if (!velocity && actuator.mode != DriveMode::CyclicSyncTorque && actuator.mode != DriveMode::CyclicSyncPosition) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " has a drive in mode " + std::to_string(static_cast<int>(actuator.mode)) +
                       ", which no joint can be moved in; allowed are 8, 9 and 10 (cyclic synchronous position, "
                       "velocity and torque)");
  }
  if (velocity && !(actuator.position_gain > 0 && actuator.position_gain * period_s <= kMostOfACycle)) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who + " has a drive in velocity mode, and a position gain of " +
                       std::to_string(actuator.position_gain) + " 1/s; it must be above 0 and at most " +
                       std::to_string(kMostOfACycle / period_s));
  }
  if (!velocity && actuator.position_gain != 0) {
    return failure(MinorCode::InvalidParameterValue,
                   "servo loop: " + who +
                       " has a position gain, which only a drive in cyclic synchronous velocity (mode 9) needs");
  }
  return {};
}

Expected<> check_drives(const ServoLoopParts& parts) {
  std::vector<std::pair<const ServoBus*, std::uint32_t>> taken;
  const auto take = [&taken](const ServoBus* bus, std::uint32_t axis, const std::string& who) -> Expected<> {
    if (auto ok = check_drive(bus, axis, who); !ok) return ok;
    if (std::find(taken.begin(), taken.end(), std::pair{bus, axis}) != taken.end()) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + who + " is bus axis " + std::to_string(axis) + ", which is taken already");
    }
    taken.emplace_back(bus, axis);
    return {};
  };
  for (std::size_t i = 0; i < parts.actuators.size(); ++i) {
    const ServoActuator& actuator = parts.actuators[i];
    const std::string who = "actuator " + std::to_string(i);
    if (auto ok = take(actuator.bus.get(), actuator.axis, who); !ok) return ok;
    const DriveScale& scale = actuator.scale;
    if (!(scale.counts_per_revolution > 0) || !(scale.rated_torque_nm > 0) || std::abs(scale.direction) != 1) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + who +
                         " needs counts a revolution and a rated torque above 0, and a direction of "
                         "1 or -1");
    }
    if (auto ok = check_mode(actuator, parts.period_s, who); !ok) return ok;
  }
  for (std::size_t i = 0; i < parts.spindles.size(); ++i) {
    const std::string who = "spindle " + std::to_string(i);
    if (auto ok = take(parts.spindles[i].bus.get(), parts.spindles[i].axis, who); !ok) return ok;
    if (auto ok = check_spindle(parts.spindles[i], "servo loop: " + who); !ok) return ok;
  }
  for (std::size_t j = 0; j < parts.axes.size(); ++j) {
    const auto& sensor = parts.axes[j].force_sensor;
    if (!sensor) continue;
    const std::string who = "the force sensor of " + joint_text(j);
    if (auto ok = check_drive(sensor->bus.get(), sensor->axis, who); !ok) return ok;
    if (!(std::abs(sensor->newton_per_count) > 0) || !std::isfinite(sensor->newton_per_count)) {
      return failure(MinorCode::InvalidParameterValue, "servo loop: " + who + " needs a scale other than 0");
    }
  }
  return {};
}

Expected<> check_inputs(const ServoLoopParts& parts) {
  for (const ServoDriveInput& input : parts.drive_inputs) {
    if (input.actuator < parts.actuators.size()) continue;
    return failure(MinorCode::InvalidParameterValue, "servo loop: an input is told by actuator " +
                                                         std::to_string(input.actuator) + ", and there are " +
                                                         std::to_string(parts.actuators.size()));
  }
  for (const ServoLimit& limit : parts.limits) {
    if (limit.joint < parts.axes.size()) continue;
    return failure(MinorCode::InvalidParameterValue, "servo loop: a limit switch is of " + joint_text(limit.joint) +
                                                         ", and there are " + std::to_string(parts.axes.size()));
  }
  return {};
}

}  // namespace

ServoBus::ServoBus(std::shared_ptr<DigitalControlInterface> bus_interface)
    : interface(std::move(bus_interface)), commands(interface->axis_count()), feedback(interface->axis_count()) {}

Expected<std::unique_ptr<ServoLoop>> ServoLoop::create(ServoLoopParts parts) {
  return check_counts(parts)
      .and_then([&] { return check_axes(parts); })
      .and_then([&] { return check_drives(parts); })
      .and_then([&] { return check_inputs(parts); })
      .and_then([&]() -> Expected<std::unique_ptr<ServoLoop>> {
        auto impl = std::make_unique<Impl>(std::move(parts));
        auto sound = impl->check_modes().and_then([&] { return impl->check_homing(); });
        return sound.map([&] { return std::unique_ptr<ServoLoop>(new ServoLoop(std::move(impl))); });
      });
}

Expected<> ServoLoop::Impl::check_modes() const {
  for (std::size_t j = 0; j < axes && !parts.virtual_mode; ++j) {
    const bool takes_torque = (actuators_of[j] & torque_drives) != 0;
    const bool follows_itself = (actuators_of[j] & ~torque_drives) != 0;
    if (takes_torque && follows_itself) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + joint_text(j) +
                         " is moved by drives that take a torque and by others that follow a position or velocity "
                         "themselves; give them all the same kind of mode");
    }
    if (takes_torque && !parts.axes[j].law)
      return failure(MinorCode::InvalidParameter, "servo loop: " + joint_text(j) +
                                                      " has no servo law, and its drive takes a torque; choose one "
                                                      "(SetMechanismJointServoControlLaw)");
    if (!takes_torque && parts.axes[j].law) {
      return failure(MinorCode::InvalidParameterValue,
                     "servo loop: " + joint_text(j) +
                         " has a servo law, but its drive closes the loop itself (cyclic synchronous position or "
                         "velocity); leave the law out, or put the drive in torque mode");
    }
  }
  return {};
}

ServoLoop::Impl::Impl(ServoLoopParts loop_parts)
    : parts(std::move(loop_parts)),
      joints(parts.kinematics->joint_count()),
      axes(parts.axes.size()),
      actuators(parts.actuators.size()) {
  const auto add_bus = [this](const std::shared_ptr<ServoBus>& bus) {
    if (std::find(buses.begin(), buses.end(), bus) == buses.end()) buses.push_back(bus);
  };
  for (const ServoActuator& actuator : parts.actuators) add_bus(actuator.bus);
  for (const ServoSpindle& spindle : parts.spindles) add_bus(spindle.bus);
  for (const ServoAxis& axis : parts.axes) {
    if (axis.force_sensor) add_bus(axis.force_sensor->bus);
  }

  for (const ServoSpindle& spindle : parts.spindles) spindles.emplace_back(spindle, parts.period_s);
  for (const ServoActuator& actuator : parts.actuators) {
    const std::uint32_t bit = std::uint32_t{1} << latches.size();
    if (actuator.mode == DriveMode::CyclicSyncTorque) torque_drives |= bit;
    if (actuator.bus->interface->answers_late(actuator.axis)) late_drives |= bit;
    latches.push_back(actuator.probe_edge ? std::optional(ProbeLatch(*actuator.probe_edge)) : std::nullopt);
  }

  std::array<double, kMaxJoints> zero{};
  std::array<bool, kMaxJoints> reached{};
  for (std::size_t j = 0; j < axes; ++j) {
    if (parts.axes[j].law) parts.axes[j].law->set_effort_limit(parts.axes[j].max_effort);
    std::array<double, kMaxJoints> unit{};
    std::array<double, kMaxJoints> torques{};
    unit[j] = 1;
    parts.actuator_map->actuator_efforts({zero.data(), axes}, {unit.data(), axes}, {torques.data(), actuators});
    for (std::size_t i = 0; i < actuators; ++i) {
      if (torques[i] == 0) continue;
      actuators_of[j] |= std::uint32_t{1} << i;
      joint_of[i] = static_cast<std::uint8_t>(j);
      const bool shared = reached[i];
      reached[i] = true;
      sense[i] = static_cast<std::int8_t>(shared ? 0 : torques[i] > 0 ? 1 : -1);
    }
    if ((actuators_of[j] & late_drives) != 0) late_joints |= std::uint32_t{1} << j;
    corrections.emplace_back(parts.axes[j].mechanics);
    force_loops.emplace_back(parts.axes[j].force, parts.period_s);
    filters.emplace_back(parts.axes[j].mechanics, parts.period_s);
  }
  if (parts.virtual_mode) std::copy(parts.virtual_start.begin(), parts.virtual_start.end(), hold.begin());
  if (parts.virtual_mode) position = hold;
}

ServoLoop::ServoLoop(std::unique_ptr<Impl> impl) noexcept : impl_(std::move(impl)) {}
ServoLoop::~ServoLoop() = default;

std::size_t ServoLoop::joint_count() const noexcept {
  return impl_->joints;
}
std::size_t ServoLoop::axis_count() const noexcept {
  return impl_->axes;
}
const ServoLoopParts& ServoLoop::parts() const noexcept {
  return impl_->parts;
}
const ServoBus* ServoLoop::bus(std::size_t index) const noexcept {
  return index < impl_->buses.size() ? impl_->buses[index].get() : nullptr;
}
ServoState ServoLoop::state() const noexcept {
  return impl_->state;
}
std::span<const double> ServoLoop::hold_position() const noexcept {
  return {impl_->hold.data(), impl_->axes};
}

}  // namespace rmac
