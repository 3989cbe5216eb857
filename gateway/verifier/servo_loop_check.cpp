#include "gateway/verifier/servo_loop_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "gateway/dynamics/axis_models.hpp"
#include "gateway/dynamics/least_jerk_way.hpp"
#include "gateway/verifier/machine_rig.hpp"

namespace rmac::verifier {
namespace {

/// The part of a joint's following-error bound that may be left half a second after a move.
constexpr double kRestShare = 0.2;

/// The part of a joint's largest effort by which the effort may swing at a steady speed: friction does not change
/// there, which could hold a loop that is unstable by itself, and what the encoder's steps make of a loop that is
/// stable is less.
constexpr double kSwingShare = 0.25;

/// What a way may ask for of a joint's limits, and how far it goes, in mm or degrees.
constexpr double kShare = 0.5, kMost = 10;

/// How far a joint goes from where it stands: to the side that has more room.
double reach(const JointLimits& limits, double from) {
  const double above = ends_above(limits) ? limits.max - from : kMost;
  const double below = ends_below(limits) ? from - limits.min : kMost;
  return above >= below ? std::min(kMost, 0.5 * above) : -std::min(kMost, 0.5 * below);
}

/// One joint's way there, within its limits.
gateway::LeastJerkWay way_within(const JointLimits& limits, double from) {
  const double by = reach(limits, from);
  return {from, by, std::max(gateway::LeastJerkWay::least_time_s(limits, std::abs(by), kShare), 0.05)};
}

/// One joint's way there, most of it at a steady speed.
struct SteadyWay {
  double from = 0, speed = 0, ramp_s = 0;
  static constexpr double kSteady_s = 1;

  static SteadyWay within(const sdk::Joint& joint, double from) {
    const JointLimits& limits = joint.limits;
    const double room = reach(limits, from);
    // Peaks of v(τ) = 3 τ² - 2 τ³ over τ from 0 to 1: of its derivatives 1.5 and 6.
    const double most = std::min(std::abs(room) / kSteady_s, kShare * limits.max_speed);
    const double ramp_s = std::max(
        {1.5 * most / (kShare * limits.max_acceleration), std::sqrt(6 * most / (kShare * limits.max_jerk)), 0.05});
    return {from, std::copysign(std::min(most, std::abs(room) / (kSteady_s + ramp_s)), room), ramp_s};
  }
  [[nodiscard]] double time_s() const { return kSteady_s + 2 * ramp_s; }
  /// The last third of the steady part, in which a loop that is stable has settled.
  [[nodiscard]] bool is_settled(double t_s) const {
    return t_s > ramp_s + kSteady_s * 2 / 3 && t_s < ramp_s + kSteady_s;
  }
  [[nodiscard]] std::array<double, 3> at(double t_s) const {
    const double whole = speed * (kSteady_s + ramp_s), left_s = time_s() - t_s;
    if (t_s < ramp_s) return ramp(t_s);
    if (left_s >= ramp_s) return {from + speed * (t_s - 0.5 * ramp_s), speed, 0};
    const auto [s, v, a] = ramp(std::max(left_s, 0.0));
    return {from + whole - (s - from), v, -a};
  }

 private:
  [[nodiscard]] std::array<double, 3> ramp(double t_s) const {
    const double u = t_s / ramp_s;
    return {from + speed * ramp_s * u * u * u * (1 - 0.5 * u), speed * u * u * (3 - 2 * u),
            speed / ramp_s * 6 * u * (1 - u)};
  }
};

class ServoLoopCheck {
 public:
  explicit ServoLoopCheck(MachineRig& rig)
      : rig_(rig),
        cycle_s_(rig.period_s()),
        device_(rig.mechanism().device),
        loop_(*rig.mechanism().loop),
        command_(rig.command()) {}

  Checked run() {
    if (auto fine = rig_.power_up(); !fine) return fine;
    if (auto fine = rest(); !fine) return fine;
    for (std::size_t j = 0; j < loop_.joint_count(); ++j) {
      const sdk::Joint& joint = device_.joints[j];
      if (joint.method == ControlMethod::Force) continue;
      const auto way = way_within(joint.limits, command_.setpoint.position[j]);
      for (const auto& each : {way, way.back()}) {
        if (auto fine = go(j, each).and_then([&] { return rest(); }); !fine) return fine;
      }
      const SteadyWay steady = SteadyWay::within(joint, command_.setpoint.position[j]);
      if (auto fine = go_steadily(j, steady).and_then([&] { return rest(); }); !fine) return fine;
    }
    for (std::size_t i = 0; i < device_.spindles.size(); ++i) {
      for (const double rpm : {device_.spindles[i].max_speed_rpm, 0.0}) {
        if (auto fine = turn(i, rpm); !fine) return fine;
      }
    }
    return {};
  }

 private:
  [[nodiscard]] const sdk::Joint& joint_of(std::size_t number) const { return sdk::joint_at(device_, number); }
  [[nodiscard]] tl::unexpected<CounterExample> fault(std::string what) const {
    return rig_.fault("stability", std::move(what));
  }

  Checked go(std::size_t j, const gateway::LeastJerkWay& way) {
    const auto cycles = static_cast<int>(std::ceil(way.time_s / cycle_s_));
    for (int i = 1; i <= cycles; ++i) {
      if (auto fine = follow(j, way.at(i * cycle_s_)); !fine) return fine;
    }
    return {};
  }

  Checked follow(std::size_t j, const std::array<double, 3>& setpoint) {
    std::tie(command_.setpoint.position[j], command_.setpoint.velocity[j], command_.setpoint.acceleration[j]) =
        std::tuple_cat(setpoint);
    return rig_.cycle();
  }

  /// At a steady speed the effort hardly changes.
  Checked go_steadily(std::size_t j, const SteadyWay& way) {
    const auto cycles = static_cast<int>(std::ceil(way.time_s() / cycle_s_));
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (int i = 1; i <= cycles; ++i) {
      if (auto fine = follow(j, way.at(i * cycle_s_)); !fine) return fine;
      if (!way.is_settled(i * cycle_s_)) continue;
      least = std::min(least, rig_.report().effort[j]);
      most = std::max(most, rig_.report().effort[j]);
    }
    const sdk::Joint& joint = joint_of(j);
    if (most - least <= kSwingShare * joint.max_effort) return {};
    return fault(
        fmt::format("joint \"{}\" swings: at a steady speed of {} its effort goes from {} to {}; {} of its "
                    "MaxEffort is allowed",
                    joint.limits.name, way.speed, least, most, kSwingShare));
  }

  /// A spindle comes to a speed in its time, and has it a second later.
  Checked turn(std::size_t i, double rpm) {
    const sdk::Spindle& spindle = device_.spindles[i];
    const auto reached = [&] { return std::abs(rig_.report().spindle_rpm[i] - rpm) <= spindle.speed_tolerance_rpm; };
    command_.spindle_rpm[i] = rpm;
    const auto cycles = static_cast<int>(std::ceil(spindle.speed_timeout_s / cycle_s_));
    for (int k = 0; k < cycles && (k == 0 || !reached()); ++k) {
      if (auto fine = rig_.cycle(); !fine) return fine;
    }
    const bool in_time = reached();
    if (auto fine = rest(); !fine) return fine;
    if (in_time && reached()) return {};
    return fault(
        fmt::format("spindle {} {} {} rpm; it turns at {}, its SpeedTolerance is {} rpm, and its SpeedTimeout {} s", i,
                    in_time ? "does not stay at" : "does not come to", rpm, rig_.report().spindle_rpm[i],
                    spindle.speed_tolerance_rpm, spindle.speed_timeout_s));
  }

  /// A second, in whose second half every joint stands.
  Checked rest() {
    const int settle = static_cast<int>(std::lround(0.5 / cycle_s_)), watched = settle;
    for (int i = 0; i < settle + watched; ++i) {
      if (auto fine = rig_.cycle(); !fine) return fine;
      for (std::size_t j = 0; i >= settle && j < loop_.joint_count_with_held(); ++j) {
        const sdk::Joint& joint = joint_of(j);
        const double off = std::abs(rig_.report().position[j] - rig_.report().position_set[j]);
        const double bound = kRestShare * joint.max_following_error;
        if (off <= bound || joint.method == ControlMethod::Force || joint.max_following_error == 0) continue;
        return fault(
            fmt::format("joint \"{}\" is {} off where it is to stand, half a second after a move; {} is "
                        "allowed, a fifth of its following error",
                        joint.limits.name, off, bound));
      }
    }
    return {};
  }

  MachineRig& rig_;
  double cycle_s_;
  const sdk::DeviceObject& device_;
  const ServoLoop& loop_;
  ServoCommand& command_;
};

}  // namespace

void check_servo_loops(const Task& task, Watch& watch, ModuleReport& report, const std::function<void()>& tell) {
  sdk::DeviceObject device = task.device;
  if (const std::string bus = gateway::put_on_models(device); !bus.empty()) {
    report.not_checked.push_back(
        fmt::format("stability: bus {0} is not a simulated one, and device.json has no model of its axes "
                    "({0}.model.interface; docs/simulated-bus.md)",
                    bus));
    tell();
    return;
  }
  auto rig = MachineRig::assemble(task, device, false, watch);
  const Checked checked = rig ? ServoLoopCheck(**rig).run() : Checked(tl::unexpected(rig.error()));
  if (checked) {
    report.passed.emplace_back("on the axis models each joint goes there and back, follows and comes to rest");
    if (!device.spindles.empty()) report.passed.emplace_back("each spindle comes to its full speed, and to rest");
  } else {
    report.refusal = checked.error();
  }
  tell();
}

}  // namespace rmac::verifier
