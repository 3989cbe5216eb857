#include "servo/spindles/spindles.hpp"

#include <algorithm>
#include <cmath>

#include "rmac/motion/servo/servo_bus.hpp"
#include "servo/watch/drive_watch.hpp"

namespace rmac {

Spindles::Spindles(std::span<const ServoSpindle> spindles, double period_s, LoopState& state)
    : spindles_(spindles), state_(state) {
  for (const ServoSpindle& spindle : spindles) loops_.emplace_back(spindle, period_s);
}

const DriveFeedback& Spindles::told(std::size_t spindle) const noexcept {
  return spindles_[spindle].bus->feedback[spindles_[spindle].axis];
}

void Spindles::raise(ServoFault::Kind kind, std::size_t spindle, double value, double bound) noexcept {
  state_.raise({kind, ServoFault::Part::Spindle, static_cast<std::uint32_t>(spindle), value, bound});
}

double Spindles::wanted_rpm(std::size_t spindle, const ServoCommand& command) const noexcept {
  const double most = spindles_[spindle].max_speed_rpm;
  const double wanted = command.spindle_rpm[spindle];
  return state_.driving() && std::isfinite(wanted) ? std::clamp(wanted, -most, most) : 0;
}

bool Spindles::operable(std::size_t spindle) const noexcept {
  const DriveFeedback& words = told(spindle);
  const bool in_mode = words.mode == DriveMode::None || words.mode == spindles_[spindle].mode;
  return in_mode && operates(words);
}

void Spindles::read() noexcept {
  for (std::size_t i = 0; i < loops_.size(); ++i) loops_[i].read(told(i));
}

void Spindles::run(const ServoCommand& command) noexcept {
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const ServoSpindle& spindle = spindles_[i];
    if (!state_.powered() || !operable(i)) {
      loops_[i].let_go();
    } else if (!loops_[i].follow(wanted_rpm(i, command), spindle.bus->commands[spindle.axis])) {
      raise(ServoFault::Kind::NotANumber, i, std::nan(""), 0);
    }
  }
  if (!state_.powered()) std::ranges::for_each(loops_, &SpindleLoop::let_go);
}

void Spindles::watch(const ServoCommand& command) noexcept {
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    const ServoSpindle& spindle = spindles_[i];
    SpindleLoop& loop = loops_[i];
    double bound = spindle.max_torque_nm;
    if (const double tool = command.tool_torque_nm; i == 0 && tool > 0 && (bound == 0 || tool < bound)) bound = tool;
    const bool overloaded = loop.overloaded(wanted_rpm(i, command), state_.powered() ? bound : 0);
    const bool runs_away = loop.too_fast();
    if (!state_.powered()) continue;
    if (runs_away) raise(ServoFault::Kind::VelocityBound, i, loop.rpm(), spindle.max_speed_rpm);
    if (const double error = loop.following_error(); std::abs(error) > spindle.max_following_error_deg) {
      raise(ServoFault::Kind::FollowingError, i, error, spindle.max_following_error_deg);
    }
    if (overloaded) raise(ServoFault::Kind::TorqueBound, i, loop.torque_nm(), bound);
  }
}

void Spindles::fill(ServoReport& report) const noexcept {
  for (std::size_t i = 0; i < loops_.size(); ++i) {
    report.spindle_statusword[i] = told(i).statusword;
    report.spindle_rpm[i] = loops_[i].rpm();
    report.spindle_torque_nm[i] = loops_[i].torque_nm();
  }
}

}  // namespace rmac
