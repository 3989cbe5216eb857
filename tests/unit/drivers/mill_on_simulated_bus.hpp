#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "circle.hpp"
#include "conformance/loaded_module.hpp"
#include "places.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "rmac/sdk/servo_law_names.hpp"
#include "stiff_loops.hpp"

namespace rmac::mill_test {

/// A straight move from rest to rest with the shortest jerk-limited profile that reaches its feed.
class RestToRest {
 public:
  RestToRest(double length, double feed, double acceleration, double jerk) : jerk_(jerk) {
    jerk_time_ = std::min(acceleration / jerk, std::sqrt(feed / jerk));
    accel_time_ = feed / (jerk * jerk_time_) - jerk_time_;
    cruise_time_ = length / feed - 2 * jerk_time_ - accel_time_;
    EXPECT_GE(cruise_time_, 0) << "the move is too short to reach its feed";
  }
  [[nodiscard]] double duration() const { return 4 * jerk_time_ + 2 * accel_time_ + cruise_time_; }
  /// Position, velocity and acceleration along the line.
  [[nodiscard]] std::array<double, 3> at(double t) const {
    const std::array<std::pair<double, double>, 7> phases{{{jerk_time_, jerk_},
                                                           {accel_time_, 0},
                                                           {jerk_time_, -jerk_},
                                                           {cruise_time_, 0},
                                                           {jerk_time_, -jerk_},
                                                           {accel_time_, 0},
                                                           {jerk_time_, jerk_}}};
    double s = 0, v = 0, a = 0;
    for (const auto& [length, j] : phases) {
      const double d = std::clamp(t, 0.0, length);
      s += v * d + a * d * d / 2 + j * d * d * d / 6;
      v += a * d + j * d * d / 2;
      a += j * d;
      t -= d;
    }
    return {s, v, a};
  }

 private:
  double jerk_;
  double jerk_time_, accel_time_, cruise_time_;
};

/// device.json of a machine, numbers of its laws as lists of them.
inline nlohmann::json declared(const std::string& folder) {
  nlohmann::json device = nlohmann::json::parse(std::ifstream(RMAC_SOURCE_DIR "/drivers/" + folder + "/device.json"));
  for (nlohmann::json& joint : device["Joints"]) {
    for (auto& [key, value] : joint["ServoControlLaw"]["Parameters"].items()) value = {value.get<double>()};
  }
  return device;
}

/// What device.json knows of the mechanics of its joints and of the cogging of its motors.
inline void make_good(const nlohmann::json& device, ServoLoopParts& parts) {
  for (std::size_t j = 0; j < device["Joints"].size(); ++j) {
    const nlohmann::json& joint = device["Joints"][j];
    parts.joints[j].mechanics.low_pass_hz = joint["LowPass"];
    for (const nlohmann::json& one : joint["Resonances"])
      parts.joints[j].mechanics.resonances.push_back({one["Frequency"], one["Damping"], one["Width"]});
    const nlohmann::json& cogging = device["Actuators"][j]["Cogging"];
    parts.actuators[j].cogging.lead_s = cogging["Lead"];
    for (const nlohmann::json& one : cogging["Harmonics"])
      parts.actuators[j].cogging.harmonics.push_back({one["Order"], one["Cosine"], one["Sine"]});
  }
}

/// A mill with the modules and scales of its own device.json on rigid simulated axes, with loops for such, unless
/// `edit` changes them.
class Mill {
 public:
  using Edit = std::function<void(nlohmann::json& device)>;
  using EditParts = std::function<void(Mill& mill, ServoLoopParts& parts)>;

  Mill(const std::string& folder, std::shared_ptr<ServoBus> bus, const Edit& edit = {},
       const EditParts& edit_parts = {})
      : folder_(folder),
        device_(nlohmann::json::parse(std::ifstream(RMAC_SOURCE_DIR "/drivers/" + folder + "/device.json"))) {
    choose_stiff_loops(device_);
    if (edit) edit(device_);
    ServoLoopParts parts;
    parts.kinematics = make<Kinematics>(device_["Kinematics"]);
    parts.actuator_map = make<ActuatorMap>(device_["ActuatorMap"]);
    for (const char* list : {"Joints", "HeldJoints"}) {
      for (const auto& joint : device_[list]) {
        parts.joints.push_back(
            {make_law(joint), ControlMethod::Position, joint["MaxFollowingError"], joint["MaxEffort"]});
      }
    }
    for (const auto& actuator : device_["Actuators"]) {
      parts.actuators.push_back(
          {bus,
           actuator["Axis"],
           {actuator["CountsPerRevolution"], actuator["RatedTorque"], actuator["Direction"], actuator["HomeCounts"]}});
    }
    for (const auto& spindle : device_["Spindles"])
      parts.spindles.push_back({bus, spindle["Axis"], spindle["MaxSpeed"]});
    if (edit_parts) edit_parts(*this, parts);
    auto made = ServoLoop::create(std::move(parts));
    EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().message);
    loop_ = std::move(*made);
  }

  [[nodiscard]] ServoLoop& loop() { return *loop_; }
  [[nodiscard]] const nlohmann::json& device() const { return device_; }
  /// The law of a joint as device.json gives it, its gains set.
  std::shared_ptr<ServoLaw> make_law(const nlohmann::json& joint) {
    auto law = make<ServoLaw>(joint["ServoControlLaw"]);
    EXPECT_TRUE(law && law->set_gains(joint["Gains"].get<std::vector<double>>())) << joint["ServoControlLaw"];
    return law;
  }

 private:
  template <typename Port>
  std::shared_ptr<Port> make(const nlohmann::json& choice) {
    const std::string name = sdk::servo_law_module(choice["Module"].get<std::string>());
    for (const std::string& folder : {folder_, std::string("modules")}) {
      auto module = std::make_unique<conformance::LoadedModule>(folder, name);
      if (module->descriptor() == nullptr) continue;
      std::vector<std::vector<double>> numbers;
      std::vector<std::string> names;
      if (choice.contains("Parameters")) {
        for (const auto& [key, value] : choice["Parameters"].items()) {
          names.push_back(key);
          numbers.push_back(value);
        }
      }
      std::vector<sdk::Parameter> parameters;
      for (std::size_t i = 0; i < names.size(); ++i) parameters.push_back({names[i].c_str(), numbers[i], nullptr});
      auto object = module->create<Port>(parameters);
      EXPECT_TRUE(object) << module->error();
      modules_.push_back(std::move(module));
      return object;
    }
    ADD_FAILURE() << name << " is not built";
    return nullptr;
  }

  std::string folder_;
  nlohmann::json device_;
  std::vector<std::unique_ptr<conformance::LoadedModule>> modules_;  // outlive the loop
  std::unique_ptr<ServoLoop> loop_;
};

constexpr double kHunt = 0.003;  // mm
inline const Circle kFastCircle(25, 100, 1000, 10000);

/// Drives a mill on the simulated bus of the example machines.
class MillRun {
 public:
  void cycle(Mill& mill) {
    mill.loop().cycle(command_, report_);
    failed_ = failed_ || report_.fault.kind != ServoFault::Kind::None;
    EXPECT_FALSE(failed_) << "fault " << static_cast<int>(report_.fault.kind) << " of index " << report_.fault.index
                          << ", value " << report_.fault.value;
    if (!report_.follows) return;
    for (std::size_t j = 0; j < mill.loop().joint_count_with_held(); ++j) {
      const double error = std::abs(report_.position_set[j] - report_.position[j]);
      largest_error_[j] = std::max(largest_error_[j], error);
    }
  }
  void dwell(Mill& mill, int cycles) {
    for (int i = 0; i < cycles && !failed_; ++i) cycle(mill);
  }
  void hold_still(Mill& mill) {
    const std::span<const double> hold = mill.loop().hold_position();
    std::copy(hold.begin(), hold.end(), command_.setpoint.position.begin());
    command_.setpoint.velocity.fill(0);
    command_.setpoint.acceleration.fill(0);
  }
  void power_up(Mill& mill) {
    command_.power = true;
    for (int i = 0; i < 100 && !report_.follows; ++i) {
      cycle(mill);
      hold_still(mill);
    }
    EXPECT_TRUE(report_.follows);
    dwell(mill, 300);
    largest_error_.fill(0);
  }
  /// All joints together by `distance` at 2000 mm/min, with the joints' acceleration and jerk.
  void move(Mill& mill, double distance) {
    const RestToRest profile(std::abs(distance), 2000.0 / 60, 1000, 10000);
    const std::array<double, kMaxJoints> start = command_.setpoint.position;
    const double sign = distance > 0 ? 1 : -1;
    const auto cycles = static_cast<int>(std::ceil(profile.duration() / period_s_));
    for (int i = 1; i <= cycles && !failed_; ++i) {
      const auto [s, v, a] = profile.at(i * period_s_);
      for (std::size_t j = 0; j < mill.loop().joint_count(); ++j) {
        command_.setpoint.position[j] = start[j] + sign * s;
        command_.setpoint.velocity[j] = sign * v;
        command_.setpoint.acceleration[j] = sign * a;
      }
      cycle(mill);
    }
  }
  /// Two turns of a circle with the first two joints from where they stand; the second turn, as the shafts really went.
  Ballbar circle(Mill& mill, const Circle& circle, const std::function<void()>& before_cycle = {}) {
    const std::array<double, kMaxJoints> start = command_.setpoint.position;
    Ballbar ballbar(circle.radius());
    const auto turn = static_cast<int>(std::ceil(circle.turn_s() * 1000));
    for (int i = 1; i <= 2 * turn && !failed_; ++i) {
      const Circle::Point point = circle.at(i * 1e-3);
      for (std::size_t j = 0; j < 2; ++j) {
        command_.setpoint.position[j] = start[j] + point.position[j];
        command_.setpoint.velocity[j] = point.velocity[j];
        command_.setpoint.acceleration[j] = point.acceleration[j];
      }
      if (before_cycle) before_cycle();
      cycle(mill);
      const double x = truth_(0, table_mm(0)), y = truth_(1, table_mm(1));
      if (i > turn) ballbar.add(x - start[0], y - start[1]);
    }
    return ballbar;
  }
  /// The circle of the figures with DMACXYZ: 50 mm across, 6 m/min, with the joints' acceleration and jerk.
  Ballbar measure_circle(const Mill::Edit& edit, const Mill::EditParts& edit_parts = {}) {
    Mill mill("mill/3-axis/DMACXYZ", bus_, edit, edit_parts);
    power_up(mill);
    return circle(mill, kFastCircle);
  }
  /// Where the screw of an axis really stands, by its shaft.
  [[nodiscard]] double table_mm(std::size_t axis) const {
    return simulated_->plant(axis).angle_rad() * 5 / (2 * std::numbers::pi);
  }

 protected:
  double period_s_ = 0.001;  ///< of moves; bus and loop have their own
  std::shared_ptr<fieldbus::SimulatedInterface> simulated_ =
      std::make_shared<fieldbus::SimulatedInterface>(fieldbus::default_simulated_axes(), 0.001);
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(simulated_);
  /// Where the table is when the screw stands at `mm`: the same, unless a test gives the mechanics errors.
  std::function<double(std::size_t axis, double mm)> truth_ = [](std::size_t, double mm) { return mm; };
  ServoCommand command_;
  ServoReport report_;
  std::array<double, kMaxJoints> largest_error_{};
  bool failed_ = false;
};

class MillOnSimulatedBus : public testing::Test, protected MillRun {};

/// Feedforward with feedback for the two table axes: the model of the plant, `share` of it (1: as it is), on top of the
/// gains that PID has.
inline void choose_feedforward(nlohmann::json& device, double share = 1, double lead_s = 0.0017) {
  const std::vector<fieldbus::SimulatedAxis> axes = fieldbus::default_simulated_axes();
  for (std::size_t j = 0; j < device["Joints"].size(); ++j) {
    const auto& plant = std::get<fieldbus::AxisPlantParameters>(axes[j]);
    const double rad_per_mm = 2 * std::numbers::pi / plant.pitch_mm;
    nlohmann::json& joint = device["Joints"][j];
    joint["ServoControlLaw"] = {{"Module", "DMAC_FEEDFORWARDFEEDBACK_CONTROL"}, {"Parameters", {{"lead_s", {lead_s}}}}};
    // N·m and rad at the shaft to N and mm at the joint.
    for (const double gain :
         {plant.viscous_nm_s * rad_per_mm * rad_per_mm * 1000, plant.inertia_kg_m2() * rad_per_mm * rad_per_mm * 1000,
          plant.coulomb_nm * rad_per_mm * 1000}) {
      joint["Gains"].push_back(share * gain);
    }
    joint["Gains"].push_back(share * plant.gravity_nm * rad_per_mm * 1000);
  }
}

/// The fuzzy law with the gains of PID around its centre, and `effort_range` (N) for what error and rate may add.
inline void choose_fuzzy(nlohmann::json& device, double effort_range) {
  for (nlohmann::json& joint : device["Joints"]) {
    const std::vector<double> pid = joint["Gains"];
    joint["ServoControlLaw"] = {{"Module", "DMAC_FUZZY_CONTROL"}};
    joint["Gains"] = {2 * effort_range / pid[0], 2 * effort_range / pid[2], effort_range, pid[1]};
  }
}

}  // namespace rmac::mill_test
