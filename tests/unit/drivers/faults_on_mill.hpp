#pragma once

#include <random>
#include <string>

#include "mill_on_simulated_bus.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::mill_test {

/// What goes wrong, on purpose.
enum class Injection {
  DriveTrip,
  DriveSilent,
  BusFails,
  EncoderLost,  ///< the drive reports it: 7305h
  EncoderJumps,
  EncoderFreezes,
  DriveRunsAway,
  Collision,  ///< more torque from outside than the axis may give
  SensorLost,
  CyclesLost,
  Count
};

inline const char* to_string(Injection injection) {
  constexpr std::array<const char*, static_cast<std::size_t>(Injection::Count)> kNames{
      "DriveTrip",      "DriveSilent",   "BusFails",  "EncoderLost", "EncoderJumps",
      "EncoderFreezes", "DriveRunsAway", "Collision", "SensorLost",  "CyclesLost"};
  return kNames.at(static_cast<std::size_t>(injection));
}

inline std::vector<Injection> every_injection() {
  std::vector<Injection> all;
  for (int i = 0; i < static_cast<int>(Injection::Count); ++i) all.push_back(static_cast<Injection>(i));
  return all;
}

/// What one fault led to.
struct FaultOutcome {
  int detected_after = -1;  ///< cycles; -1: not within its bound
  int bound = 0;            ///< cycles
  ServoFault fault;
  StopCategory wanted = StopCategory::StopThenRemovePower;
  double stopped_after_mm = 0;  ///< largest way of an axis, as its shaft really went, after it was detected
  bool stopped = false;         ///< every shaft stands, with power where it is to be kept, and without where not
  std::string where;            ///< what was done, to be done again
};

/// DMACXYZ going round the circle of the figures; then something breaks, at a random instant on a random axis. Bounds
/// and stop categories are those of device.json and of this run; positions are the shafts' own.
class FaultOnMill : public MillRun {
 public:
  explicit FaultOnMill(unsigned seed) : random_(seed) {}

  FaultOutcome run(Injection injection) {
    const bool keep_power = random_() % 2 == 0;
    outcome_ = {};
    Mill mill("mill/3-axis/DMACXYZ", bus_, {},
              [&](Mill& made, ServoLoopParts& parts) { watch(made.device(), parts, keep_power); });
    simulated_->set_contact({.axis = 2, .surface_mm = -40});
    power_up_quickly(mill);
    go_round(mill, 200 + static_cast<int>(random_() % 800));
    const auto axis = random_() % (injection == Injection::EncoderFreezes ? 2 : 3);
    inject(injection, axis);
    outcome_.where = std::string(to_string(injection)) + " on axis " + std::to_string(axis) + " in cycle " +
                     std::to_string(cycles_) + (keep_power ? ", power to be kept" : "");
    if (injection == Injection::EncoderFreezes) outcome_.bound = frozen_bound(axis);
    for (int i = 1; i <= outcome_.bound && outcome_.detected_after < 0; ++i) {
      go_round(mill, 1);
      command_.cycles_missed = 0;
      if (report_.fault.kind != ServoFault::Kind::None) outcome_.detected_after = i;
    }
    if (outcome_.detected_after < 0) return outcome_;
    stop(mill, injection, axis);
    return outcome_;
  }

 private:
  static constexpr double kJump = 0.05;   // mm; DMACXYZ accelerates by 0.001 mm a cycle and cycle
  static constexpr double kTorque = 0.7;  // N·m; its largest effort asks for 0.64
  static constexpr int kStopCycles = 1500;
  static constexpr int kRestCycles = 300;

  void watch(const nlohmann::json& device, ServoLoopParts& parts, bool keep_power) {
    for (std::size_t j = 0; j < parts.joints.size(); ++j) {
      const auto& joint = device["Joints"][j];
      parts.joints[j].bounds = {1.2 * joint["MaxSpeed"].get<double>(), kJump, joint["MaxAcceleration"]};
    }
    for (ServoActuator& actuator : parts.actuators) actuator.max_torque_nm = kTorque;
    parts.joints[2].force_sensor = ServoForceSensor{bus_, 2, 0.01, 0};
    parts.max_cycles_lost = 5;
    if (!keep_power) {
      parts.stop_categories.drive_silent = StopCategory::StopThenRemovePower;
      return;
    }
    constexpr auto kKeep = StopCategory::StopKeepPower;
    parts.stop_categories = {kKeep, kKeep, kKeep, kKeep, kKeep, kKeep};
    keep_power_ = true;
  }
  void power_up_quickly(Mill& mill) {
    command_.power = true;
    for (int i = 0; i < 100 && !report_.follows; ++i) {
      mill.loop().cycle(command_, report_);
      hold_still(mill);
    }
    start_ = command_.setpoint.position;
    EXPECT_TRUE(report_.follows);
  }
  void go_round(Mill& mill, int cycles) {
    for (int i = 0; i < cycles; ++i) {
      const Circle::Point point = kFastCircle.at(++cycles_ * 1e-3);
      for (std::size_t j = 0; j < 2; ++j) {
        command_.setpoint.position[j] = start_[j] + point.position[j];
        command_.setpoint.velocity[j] = point.velocity[j];
        command_.setpoint.acceleration[j] = point.acceleration[j];
      }
      mill.loop().cycle(command_, report_);
    }
  }

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  double either_way(double value) { return random_() % 2 == 0 ? value : -value; }

  void inject(Injection injection, std::size_t axis) {
    outcome_.wanted = StopCategory::StopThenRemovePower;
    const auto may_keep = [this] {
      if (keep_power_) outcome_.wanted = StopCategory::StopKeepPower;
    };
    outcome_.bound = 1;
    switch (injection) {
      case Injection::DriveTrip:
        return simulated_->trip(axis, static_cast<std::uint16_t>(0x2000 + random_() % 0x5000));
      case Injection::DriveSilent:
        may_keep();
        return simulated_->set_online(axis, false);
      case Injection::BusFails:
        return simulated_->set_bus_failed(true);
      case Injection::EncoderLost:
        return simulated_->trip(axis, 0x7305);
      case Injection::EncoderJumps: {
        const double mm = either_way(uniform(1.2 * kJump, 100));
        return simulated_->shift_encoder(axis, static_cast<std::int32_t>(std::lround(mm / 5 * 131072)));
      }
      case Injection::EncoderFreezes:
        return simulated_->freeze_encoder(axis, true);
      case Injection::DriveRunsAway:
        // Beyond its torque bound at once; 3 cycles, one more until the drive acts, and its current loop's lag.
        outcome_.bound = 6;
        return simulated_->run_away(axis, either_way(uniform(1.1 * kTorque, 0.95)));
      case Injection::Collision:
        // From rest, what is beyond the largest torque takes the axis over its following error in this time.
        outcome_.bound = 80;
        return simulated_->push(axis, either_way(uniform(1.2, 3.0)));
      case Injection::SensorLost:
        may_keep();
        return simulated_->set_sensor_lost(true);
      case Injection::CyclesLost:
        may_keep();
        command_.cycles_missed = 6 + random_() % 20;
        return;
      case Injection::Count:
        return;
    }
  }

  /// A frozen encoder shows when the setpoint has left it by the following-error bound: never later than that.
  int frozen_bound(std::size_t axis) {
    const double from = kFastCircle.at(cycles_ * 1e-3).position[axis];
    for (int i = 1; i < 5000; ++i) {
      if (std::abs(kFastCircle.at((cycles_ + i) * 1e-3).position[axis] - from) > 0.5 + 0.1) return i + 1;
    }
    return 5000;
  }

  void stop(Mill& mill, Injection injection, std::size_t axis) {
    outcome_.fault = report_.fault;
    std::array<double, 3> at{}, rest{}, astray{};
    for (std::size_t j = 0; j < 3; ++j) at[j] = table_mm(j);
    for (int i = 0; i < kStopCycles; ++i) {
      // What pushed is gone when the machine has stopped pushing back.
      if (i == 300 && injection == Injection::Collision) simulated_->push(axis, 0);
      mill.loop().cycle(command_, report_);
      for (std::size_t j = 0; j < 3; ++j) {
        outcome_.stopped_after_mm = std::max(outcome_.stopped_after_mm, std::abs(table_mm(j) - at[j]));
        if (i == kStopCycles - kRestCycles) rest[j] = table_mm(j);
        if (i >= kStopCycles - kRestCycles) astray[j] = std::max(astray[j], std::abs(table_mm(j) - rest[j]));
      }
    }
    outcome_.fault = report_.fault;
    outcome_.stopped = true;
    for (std::size_t j = 0; j < 3; ++j) {
      const bool stands = astray[j] < 2 * kHunt;  // static friction and the integral play against each other
      const bool powered = (bus_->commands[j].controlword & controlword::kEnableOperation) != 0;
      const bool off = (bus_->commands[j].controlword & controlword::kEnableVoltage) == 0;
      const bool left_out = injection == Injection::DriveSilent && j == axis;
      const bool kept = left_out ? !powered : powered;
      const bool as_wanted = report_.fault.stop == StopCategory::StopKeepPower ? kept : off;
      outcome_.stopped = outcome_.stopped && stands && as_wanted;
      if (!stands) outcome_.where += "; axis " + std::to_string(j) + " still moves";
      if (!as_wanted) outcome_.where += "; axis " + std::to_string(j) + " has the wrong power";
    }
  }

  std::mt19937 random_;
  FaultOutcome outcome_;
  std::array<double, kMaxJoints> start_{};
  int cycles_ = 0;
  bool keep_power_ = false;
};

}  // namespace rmac::mill_test
