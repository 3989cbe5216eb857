// What a PID is told of its axis beside its gains.
#include <gtest/gtest.h>

#include <random>

#include "conformance/loaded_module.hpp"
#include "rmac/motion/ports/servo_law.hpp"

namespace rmac {
namespace {

using conformance::LoadedModule;

constexpr double kViscous = 0.16, kMass = 0.035, kFriction = 19, kWeight = -118, kLead_s = 0.0033, kWay = 0.0098,
                 kBreakaway = 1.2, kStribeck = 1.4, kBand = 0.002;

/// The model's parameters that PID and feedforward with feedback both take.
std::vector<sdk::Parameter> shared() {
  return {{"lead_s", {&kLead_s, 1}, nullptr},
          {"presliding", {&kWay, 1}, nullptr},
          {"breakaway", {&kBreakaway, 1}, nullptr},
          {"stribeck_speed", {&kStribeck, 1}, nullptr},
          {"rest_band", {&kBand, 1}, nullptr}};
}

TEST(PidServoLaw, WithAModelInItsParametersIsFeedforwardWithFeedback) {
  std::vector<sdk::Parameter> all = shared();
  all.push_back({"viscous", {&kViscous, 1}, nullptr});
  all.push_back({"mass", {&kMass, 1}, nullptr});
  all.push_back({"friction", {&kFriction, 1}, nullptr});
  all.push_back({"load", {&kWeight, 1}, nullptr});
  LoadedModule pids("modules", "PIDServoControlLaw"), models("modules", "FeedforwardFeedbackServoControlLaw");
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const auto pid = pids.create<ServoLaw>(all);
    const auto model = models.create<ServoLaw>(shared());
    ASSERT_TRUE(pid && model) << pids.error() << models.error();
    ASSERT_TRUE(pid->set_gains(std::array{345.0, 14600.0, 6.0}));
    ASSERT_TRUE(model->set_gains(std::array{345.0, 14600.0, 6.0, kViscous, kMass, kFriction, kWeight}));
    EXPECT_EQ(pid->resting_effort(), kWeight);
    std::mt19937 random(seed);
    std::normal_distribution<double> any;
    ServoInput input;
    for (ServoLaw* law : {pid.get(), model.get()}) {
      law->set_effort_limit(300);
      law->engage(input, 20);
    }
    for (int i = 0; i < 2000; ++i) {
      input.acceleration_setpoint = 500 * any(random);
      input.velocity_setpoint += input.acceleration_setpoint * 1e-3;
      input.position_setpoint += input.velocity_setpoint * 1e-3;
      input.position = input.position_setpoint + 0.01 * any(random);
      input.velocity = input.velocity_setpoint + any(random);
      ASSERT_EQ(pid->update(input), model->update(input)) << "seed " << seed << " cycle " << i;
    }
  }
}

TEST(PidServoLaw, RefusesAModelThatPushesTheWrongWay) {
  const double below = -1;
  for (const char* name : {"viscous", "mass", "friction", "presliding", "lead_s"}) {
    LoadedModule module("modules", "PIDServoControlLaw");
    EXPECT_FALSE(module.create<ServoLaw>(std::array{sdk::Parameter{name, {&below, 1}, nullptr}})) << name;
    EXPECT_NE(module.error().find(std::string(name) + " must be one number from 0"), std::string::npos)
        << module.error();
  }
}

}  // namespace
}  // namespace rmac
