#include <algorithm>
#include <cmath>

#include "servo/servo_loop_impl.hpp"

namespace rmac {

const DriveFeedback& ServoLoop::Impl::spindle_feedback(std::size_t spindle) const noexcept {
  const ServoSpindle& part = parts.spindles[spindle];
  return part.bus->feedback[part.axis];
}

/// A stop that keeps power ends with spindles at rest too.
double ServoLoop::Impl::wanted_rpm(std::size_t spindle, const ServoCommand& command) const noexcept {
  const double most = parts.spindles[spindle].max_speed_rpm;
  const double wanted = command.spindle_rpm[spindle];
  return driving() && std::isfinite(wanted) ? std::clamp(wanted, -most, most) : 0;
}

void ServoLoop::Impl::read_spindles() noexcept {
  for (std::size_t i = 0; i < spindles.size(); ++i) spindles[i].read(spindle_feedback(i));
}

void ServoLoop::Impl::run_spindles(const ServoCommand& command) noexcept {
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    const ServoSpindle& part = parts.spindles[i];
    const DriveFeedback& words = spindle_feedback(i);
    const bool in_mode = words.mode == DriveMode::None || words.mode == part.mode;
    const bool operable = words.online && in_mode && drive_state(words.statusword) == DriveState::OperationEnabled;
    if (!powered() || !operable) {
      spindles[i].let_go();
    } else if (!spindles[i].follow(wanted_rpm(i, command), part.bus->commands[part.axis])) {
      raise({ServoFault::Kind::NotANumber, ServoFault::Part::Spindle, static_cast<std::uint32_t>(i), std::nan(""), 0});
    }
  }
  if (!powered()) std::ranges::for_each(spindles, &SpindleLoop::let_go);
}

void ServoLoop::Impl::watch_spindles(const ServoCommand& command) noexcept {
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    const ServoSpindle& part = parts.spindles[i];
    SpindleLoop& spindle = spindles[i];
    double bound = part.max_torque_nm;
    if (const double tool = command.tool_torque_nm; i == 0 && tool > 0 && (bound == 0 || tool < bound)) bound = tool;
    const bool overloaded = spindle.overloaded(wanted_rpm(i, command), powered() ? bound : 0);
    const bool runs_away = spindle.too_fast();
    if (!powered()) continue;
    const auto stop = [&](ServoFault::Kind kind, double value, double allowed) {
      raise({kind, ServoFault::Part::Spindle, static_cast<std::uint32_t>(i), value, allowed});
    };
    if (runs_away) stop(ServoFault::Kind::VelocityBound, spindle.rpm(), part.max_speed_rpm);
    if (const double error = spindle.following_error(); std::abs(error) > part.max_following_error_deg) {
      stop(ServoFault::Kind::FollowingError, error, part.max_following_error_deg);
    }
    if (overloaded && driving()) stop(ServoFault::Kind::TorqueBound, spindle.torque_nm(), bound);
  }
}

void ServoLoop::Impl::write_spindles() noexcept {
  for (std::size_t i = 0; i < spindles.size(); ++i) {
    const ServoSpindle& part = parts.spindles[i];
    DriveCommand& words = part.bus->commands[part.axis];
    words.controlword = next_controlword(spindle_feedback(i).statusword, wish(ServoFault::Part::Spindle, i), resetting,
                                         words.controlword);
    spindles[i].command(words);
  }
}

}  // namespace rmac
