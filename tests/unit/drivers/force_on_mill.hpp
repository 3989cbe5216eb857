#pragma once

#include "honest_axes.hpp"
#include "mill_on_simulated_bus.hpp"
#include "rmac/motion/servo/servo_handover.hpp"

namespace rmac::mill_test {

/// What a pass along a surface with a wanted force came to.
struct ForcePass {
  double wanted_n = 0;
  double approach_set_mm_s = 0;  ///< fastest that was asked for before contact
  double touch_mm_s = 0;         ///< at contact
  double overshoot_n = 0;        ///< most beyond the wanted force on the way to it
  double settled_s = 0;          ///< from contact until the force stays within 2 %
  double rest_rms_share = 0;     ///< of the wanted force, that it is wrong by in the second before the pass
  double rms_share = 0;          ///< the same during the pass
  double worst_share = 0;
  double path_error_mm = 0;        ///< of the axes that follow the path, at the shafts
  double release_torque_step = 0;  ///< share of the rated torque, where position control takes over again
  double release_jump_mm = 0;      ///< of the axis, in the half second after that
};

/// How it presses.
struct Pressing {
  double force_n = 200;
  double approach_mm_s = 5;
  double dwell_s = 0;        ///< pressing, before it goes along
  double speed_mm_s = 10;    ///< along
  int answer_delay = 0;      ///< of the drives, in cycles
  bool as_it_comes = false;  ///< axes that bend, stick and cog, with what device.json has for them; or rigid ones
  std::uint64_t seed = 1;    ///< of their encoders
};

/// DMACXYZ pressing on a sheet that rises and waves, as a tool for friction stir welding does: X goes along, Z keeps
/// the force. Forces are those of the plant, not of the sensor.
class ForceOnMill : public MillRun {
 public:
  explicit ForceOnMill(const Pressing& pressing = {}) : pressing_(pressing) {
    if (pressing.as_it_comes)
      simulated_ = std::make_shared<fieldbus::SimulatedInterface>(honest_axes(310, 0.03, pressing.seed), 0.001);
    if (pressing.answer_delay > 0) simulated_->set_answer_delay(pressing.answer_delay);
    bus_ = std::make_shared<ServoBus>(simulated_);
  }
  ForcePass press_and_go(const fieldbus::SimulatedContact& sheet) {
    simulated_->set_contact(sheet);
    pass_.wanted_n = pressing_.force_n;
    Mill mill = make([this](const nlohmann::json& joint, ServoLoopParts& parts) { press_with_z(joint, parts); });
    power_up(mill);
    approach(mill);
    along(mill, sheet);
    if (!failed_) hand_back(mill);
    return pass_;
  }
  [[nodiscard]] bool failed() const { return failed_; }

 private:
  static constexpr double kShare = 0.02;

  Mill make(const std::function<void(const nlohmann::json& z, ServoLoopParts& parts)>& edit = {}) {
    const auto as_it_comes = [this](nlohmann::json& device) {
      if (pressing_.as_it_comes) device = declared("mill/3-axis/DMACXYZ");
    };
    return {"mill/3-axis/DMACXYZ", bus_, as_it_comes, [&](Mill& made, ServoLoopParts& parts) {
              if (pressing_.as_it_comes) make_good(made.device(), parts);
              if (edit) edit(made.device()["Joints"][2], parts);
            }};
  }

  void press_with_z(const nlohmann::json& joint, ServoLoopParts& parts) const {
    const auto& force = joint["ForceControl"];
    parts.joints[2].method = ControlMethod::Force;
    parts.joints[2].force = {.approach_speed = pressing_.approach_mm_s,
                             .contact_force = force["ContactForce"],
                             .max_speed = force["MaxSpeed"],
                             .max_force = force["MaxForce"],
                             .max_search = force["MaxSearch"],
                             .max_acceleration = joint["MaxAcceleration"]};
    parts.joints[2].bounds.min_position = joint["Min"];
    parts.joints[2].bounds.max_position = joint["Max"];
    parts.joints[2].force_sensor = ServoForceSensor{bus_, 2, joint["ForceSensor"]["NewtonPerCount"], 0};
  }
  /// What the axis really presses with.
  [[nodiscard]] double pressed_n() const { return simulated_->plant(2).contact_nm() * 2 * std::numbers::pi / 5e-3; }
  [[nodiscard]] double share() const { return pressed_n() / pass_.wanted_n - 1; }
  void approach(Mill& mill) {
    command_.force[2] = -pass_.wanted_n;
    int outside = 0, touching = 0;
    double squares = 0;
    const int cycles = 4000 + static_cast<int>(1000 * pressing_.dwell_s);
    for (int i = 0; i < cycles && !failed_; ++i) {
      cycle(mill);
      if (i >= cycles - 1000) squares += share() * share();  // lost contact is an error, too
      if (report_.contact[2] == ContactState::Approaching) {
        if (touching > 0) continue;  // it bounces
        pass_.approach_set_mm_s = std::max(pass_.approach_set_mm_s, std::abs(report_.velocity_set[2]));
        pass_.touch_mm_s = std::abs(report_.velocity[2]);
        continue;
      }
      ++touching;
      pass_.overshoot_n = std::max(pass_.overshoot_n, pressed_n() - pass_.wanted_n);
      if (std::abs(share()) > kShare) outside = touching;
    }
    pass_.settled_s = outside * 1e-3;
    pass_.rest_rms_share = std::sqrt(squares / 1000);
  }
  void along(Mill& mill, const fieldbus::SimulatedContact& sheet) {
    const RestToRest profile(40, pressing_.speed_mm_s, 1000, 10000);
    const double start = command_.setpoint.position[sheet.along];
    const double y = table_mm(1);
    const auto cycles = static_cast<int>(std::ceil(profile.duration() * 1000));
    double squares = 0;
    for (int i = 1; i <= cycles && !failed_; ++i) {
      const auto [s, v, a] = profile.at(i * 1e-3);
      command_.setpoint.position[0] = start + s;
      command_.setpoint.velocity[0] = v;
      command_.setpoint.acceleration[0] = a;
      cycle(mill);
      squares += share() * share();
      pass_.worst_share = std::max(pass_.worst_share, std::abs(share()));
      pass_.path_error_mm =
          std::max({pass_.path_error_mm, std::abs(table_mm(0) - report_.position_set[0]), std::abs(table_mm(1) - y)});
    }
    pass_.rms_share = std::sqrt(squares / cycles);
    command_.setpoint.velocity.fill(0);
    command_.setpoint.acceleration.fill(0);
  }
  /// Position control for all three axes, as `Apply` puts it in: a new loop that takes the drives over.
  void hand_back(Mill& pressing) {
    dwell(pressing, 200);
    command_.force[2] = 0;
    dwell(pressing, 500);  // on a stiff part it draws back first
    const int before = bus_->commands[2].target_torque_permille;
    const double at = table_mm(2);
    Mill mill = make();
    mill.loop().engage(pressing.loop().handover());
    report_.follows = false;
    for (int i = 0; i < 500; ++i) {
      if (!report_.follows) hold_still(mill);
      cycle(mill);
      const int step = std::abs(bus_->commands[2].target_torque_permille - before);
      if (i == 0) pass_.release_torque_step = step / 1000.0;
      pass_.release_jump_mm = std::max(pass_.release_jump_mm, std::abs(table_mm(2) - at));
    }
  }

  Pressing pressing_;
  ForcePass pass_;
};

}  // namespace rmac::mill_test
