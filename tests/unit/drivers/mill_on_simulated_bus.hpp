#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "conformance/loaded_module.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/motion/servo_loop.hpp"

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

/// A mill with the modules, gains and scales of its own device.json on the simulated bus.
class Mill {
 public:
  Mill(const std::string& folder, std::shared_ptr<ServoBus> bus)
      : folder_(folder),
        device_(nlohmann::json::parse(std::ifstream(RMAC_SOURCE_DIR "/drivers/" + folder + "/device.json"))) {
    ServoLoopParts parts;
    parts.kinematics = make<Kinematics>(device_["Kinematics"]);
    parts.actuator_map = make<ActuatorMap>(device_["ActuatorMap"]);
    for (const char* list : {"Joints", "HeldJoints"}) {
      for (const auto& joint : device_[list]) {
        const auto law = make<ServoLaw>(joint["ServoControlLaw"]);
        EXPECT_TRUE(law->set_gains(joint["Gains"].get<std::vector<double>>()));
        parts.axes.push_back({law, ControlMethod::Position, joint["MaxFollowingError"], joint["MaxEffort"]});
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
    auto made = ServoLoop::create(std::move(parts));
    EXPECT_TRUE(made.has_value()) << (made ? "" : made.error().message);
    loop_ = std::move(*made);
  }

  [[nodiscard]] ServoLoop& loop() { return *loop_; }
  [[nodiscard]] const nlohmann::json& device() const { return device_; }

 private:
  template <typename Port>
  std::shared_ptr<Port> make(const nlohmann::json& choice) {
    const std::string name = choice["Module"];
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

}  // namespace rmac::mill_test
