#pragma once

#include "honest_axes.hpp"
#include "mill_on_simulated_bus.hpp"

namespace rmac::mill_test {

/// The circle of the figures on DMACXYZ with axes that bend at 274 Hz, stick, cog and ripple, and a loop that
/// `rmac tune` finds for such.
class HonestCircle : public MillRun {
 public:
  struct Known {
    double presliding = 0;  ///< mm; 0: friction turns round with the velocity
    double cogging = 0;     ///< share of the rated torque; negative: the map is the wrong way round
  };

  HonestCircle() {
    simulated_ = std::make_shared<fieldbus::SimulatedInterface>(honest_axes(274, 0.03, 1), kPeriod);
    bus_ = std::make_shared<ServoBus>(simulated_);
    truth_ = [this](std::size_t axis, double) { return simulated_->plant(axis).angle_rad() / kRadPerMm; };
  }

  Ballbar measure(double feed, const Known& known) {
    Mill mill = make(known);
    power_up(mill);
    return circle(mill, Circle(25, feed / 60, 1000, 10000));
  }
  /// Largest error on the way back after a way there and so long a rest, in mm.
  double back_after_rest(double rest_s, const Known& known) {
    Mill mill = make(known);
    power_up(mill);
    move(mill, 5.3);
    dwell(mill, static_cast<int>(rest_s * 1000));
    largest_error_.fill(0);
    move(mill, -5.3);
    return *std::max_element(largest_error_.begin(), largest_error_.end());
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  static constexpr double kPeriod = 0.001;
  static constexpr int kCoggingOrder = 60;

  Mill make(const Known& known) {
    return {"mill/3-axis/DMACXYZ", bus_, [&](nlohmann::json& device) { choose(device, known); },
            [&](Mill&, ServoLoopParts& parts) { choose(parts, known); }};
  }
  static void choose(nlohmann::json& device, const Known& known) {
    for (nlohmann::json& joint : device["Joints"]) joint["Gains"] = {345, 14586, 6.0};
    choose_feedforward(device, 1, 0.0033);
    if (known.presliding == 0) return;
    for (nlohmann::json& joint : device["Joints"]) {
      joint["ServoControlLaw"]["Parameters"].update({{"presliding", {known.presliding}},
                                                     {"breakaway", {1.2}},
                                                     {"stribeck_speed", {1.0}},
                                                     {"rest_band", {0.002}}});
    }
  }
  static void choose(ServoLoopParts& parts, const Known& known) {
    for (ServoJoint& joint : parts.joints) {
      joint.mechanics.low_pass_hz = 180;
      joint.mechanics.resonances = {{274.7, 0.05, 0.3}};
    }
    if (known.cogging == 0) return;
    for (std::size_t i = 0; i < 3; ++i) {
      ServoActuator& actuator = parts.actuators[i];  // its encoder goes as the shaft does, from the same angle
      actuator.cogging = {{{kCoggingOrder, 0, known.cogging * actuator.scale.rated_torque_nm}}, 0.0017};
    }
  }
};

}  // namespace rmac::mill_test
