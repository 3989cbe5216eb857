#include "rmac/fieldbus/two_masses.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace {

using namespace rmac::fieldbus;

constexpr double kStep = 25e-6;
constexpr double kRevolution = 2 * std::numbers::pi;

/// DMACXYZ's X as docs/simulated-bus.md gives it: 25 N/µm, 274 Hz.
TwoMassParameters frictionless() {
  return {.motor_inertia_kg_m2 = 9.29e-6, .load_inertia_kg_m2 = 1.267e-5, .stiffness_nm_rad = 15.83};
}

FrictionParameters friction(double coulomb, double presliding) {
  return {.coulomb_nm = coulomb,
          .static_nm = 1.2 * coulomb,
          .presliding_rad = presliding,
          .elastic_share = 0.3,
          .stribeck_rad_s = 1.26,
          .viscous_nm_s = 5e-5,
          .damping_nm_s_rad = 2e-3};
}

/// The textbook's equations, at a thousandth of the step: Runge-Kutta of fourth order over motor, load and bristles.
/// Shares no code with what it judges.
class Reference {
 public:
  using State = std::array<double, 6>;  // motor angle, load angle, their speeds, their bristles

  explicit Reference(const TwoMassParameters& parameters) : p_(parameters) {}

  State state{};

  void run(double duration, double dt, const std::function<double(double)>& motor_nm) {
    const auto steps = static_cast<int>(std::lround(duration / dt));
    for (int i = 0; i < steps; ++i, t_ += dt) {
      const State a = rate(state, motor_nm(t_)), b = rate(along(state, a, dt / 2), motor_nm(t_ + dt / 2)),
                  c = rate(along(state, b, dt / 2), motor_nm(t_ + dt / 2)),
                  d = rate(along(state, c, dt), motor_nm(t_ + dt));
      for (std::size_t k = 0; k < state.size(); ++k) state[k] += dt / 6 * (a[k] + 2 * b[k] + 2 * c[k] + d[k]);
    }
  }

 private:
  static State along(State from, const State& rate, double dt) {
    for (std::size_t k = 0; k < from.size(); ++k) from[k] += rate[k] * dt;
    return from;
  }
  static void rub(const FrictionParameters& f, double v, double z, double& nm, double& bends) {
    const double near = f.stribeck_rad_s > 0 ? std::exp(-v * v / (f.stribeck_rad_s * f.stribeck_rad_s)) : 1;
    nm = f.viscous_nm_s * v;
    bends = v;
    if (f.coulomb_nm == 0) return;
    const double stiff = f.coulomb_nm / f.presliding_rad;
    const double bent = stiff * z / (f.coulomb_nm + (f.static_nm - f.coulomb_nm) * near);
    const double ahead = v < 0 ? -bent : bent;
    const double slides = std::clamp((ahead - f.elastic_share) / (1 - f.elastic_share), 0.0, 1.0);
    bends = v * (1 - slides * ahead);
    nm += stiff * z + f.damping_nm_s_rad * near * v * std::max(0.0, 1 - slides * ahead);
  }
  [[nodiscard]] State rate(const State& s, double motor_nm) const {
    const double twist = s[0] - s[1], gap = p_.play_rad / 2;
    double spring = 0;
    if (std::abs(twist) > gap)
      spring = p_.stiffness_nm_rad * (twist - std::copysign(gap, twist)) + p_.damping_nm_s_rad * (s[2] - s[3]);
    State r{s[2], s[3]};
    double at_motor = 0, at_load = 0;
    rub(p_.motor_friction, s[2], s[4], at_motor, r[4]);
    rub(p_.load_friction, s[3], s[5], at_load, r[5]);
    r[2] = (motor_nm - spring - at_motor) / p_.motor_inertia_kg_m2;
    r[3] = (spring - at_load) / p_.load_inertia_kg_m2;
    return r;
  }

  TwoMassParameters p_;
  double t_ = 0;
};

void run(TwoMasses& plant, double duration, const std::function<double(double)>& motor_nm, double dt = kStep) {
  const auto steps = static_cast<int>(std::lround(duration / dt));
  for (int i = 0; i < steps; ++i) plant.step({.motor_nm = motor_nm((i + 0.5) * dt)}, dt);
}

double none(double /*t*/) {
  return 0;
}

TEST(TwoMasses, FollowAnIndependentIntegrationWithFrictionAndPlay) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 20; ++k) {
    TwoMassParameters p = frictionless();
    p.stiffness_nm_rad *= 0.5 + 3 * share(random);
    p.damping_nm_s_rad = 4e-4 * share(random);
    p.play_rad = k % 2 == 0 ? 0 : 2e-3 * share(random);
    p.motor_friction = friction(0.01 * share(random), 1e-3 + 0.02 * share(random));
    p.load_friction = friction(0.01 * share(random), 1e-3 + 0.02 * share(random));
    const double hz = 3 + 20 * share(random), nm = 0.05 + 0.1 * share(random);
    const auto motor = [&](double t) { return nm * std::sin(kRevolution * hz * t); };
    TwoMasses plant(p);
    Reference truth(p);
    double most = 0;
    for (int i = 0; i < 100; ++i) {
      const double from = i * 1e-3;
      run(plant, 1e-3, [&](double t) { return motor(from + t); });
      truth.run(1e-3, 1e-6, motor);
      most = std::max(most, std::abs(truth.state[0]));
      const double error = std::abs(plant.motor_rad() - truth.state[0]) + std::abs(plant.load_rad() - truth.state[1]);
      ASSERT_LE(error, 2e-3 * most + 2e-5) << "case " << k << " at " << from << " s, play " << p.play_rad;
    }
    EXPECT_GT(most, 1e-3) << "it moved";
  }
}

TEST(TwoMasses, SwingFreelyAtTheirFrequencyAndDamping) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 30; ++k) {
    TwoMassParameters p = frictionless();
    p.stiffness_nm_rad *= 0.3 + 4.5 * share(random);
    p.load_inertia_kg_m2 *= 0.3 + 3 * share(random);
    const double together =
        p.motor_inertia_kg_m2 * p.load_inertia_kg_m2 / (p.motor_inertia_kg_m2 + p.load_inertia_kg_m2);
    const double natural = std::sqrt(p.stiffness_nm_rad / together), ratio = 0.005 + 0.05 * share(random);
    p.damping_nm_s_rad = 2 * ratio * natural * together;
    TwoMasses plant(p);
    const double dt = std::min(kStep, plant.largest_step_s());
    plant.step({.motor_nm = 0.05 * together / dt}, dt);
    // Passages through no twist, and the peaks between them.
    std::vector<double> passed, peaks;
    double before = plant.motor_rad() - plant.load_rad(), peak = 0;
    for (int i = 1; passed.size() < 21; ++i) {
      plant.step({}, dt);
      const double twist = plant.motor_rad() - plant.load_rad();
      peak = std::max(peak, std::abs(twist));
      if (before * twist < 0) {
        passed.push_back((i + before / (before - twist)) * dt);
        peaks.push_back(std::exchange(peak, 0));
      }
      before = twist;
    }
    const double damped = natural * std::sqrt(1 - ratio * ratio);
    EXPECT_NEAR(std::numbers::pi * 20 / (passed[20] - passed[0]), damped, 2e-3 * damped);
    const double decay = std::log(peaks[2] / peaks[20]) / 18;
    EXPECT_NEAR(decay, std::numbers::pi * ratio / std::sqrt(1 - ratio * ratio), 0.03 * std::numbers::pi * ratio + 1e-3);
  }
}

TEST(TwoMasses, StickBelowStaticFrictionAndSlideAboveIt) {
  for (const double presliding : {6.3e-5, 6.3e-4, 0.0126}) {
    TwoMassParameters p = frictionless();
    p.damping_nm_s_rad = 4e-4;
    p.motor_friction = p.load_friction = friction(0.0075, presliding);
    TwoMasses plant(p);
    run(plant, 2, [](double t) { return 0.97 * 0.018 * std::min(t, 1.0); });
    EXPECT_LT(plant.load_rad(), 8 * presliding);
    EXPECT_LT(std::abs(plant.motor_rad_s()), 1e-3);
    run(plant, 1, [](double) { return 1.05 * 0.018; });
    EXPECT_GT(plant.load_rad(), 1) << "presliding " << presliding;
  }
}

TEST(TwoMasses, GiveWayLikeASpringBeforeTheySlide) {
  TwoMassParameters p = frictionless();
  p.damping_nm_s_rad = 4e-4;
  p.load_friction = friction(0.015, 0.0126);
  TwoMasses plant(p);
  const double torque = 1e-4;  // far below what slides
  run(plant, 1, [&](double) { return torque; });
  EXPECT_NEAR(plant.load_rad(), torque / (0.015 / 0.0126), 0.02 * plant.load_rad());
  EXPECT_NEAR(plant.motor_rad() - plant.load_rad(), torque / p.stiffness_nm_rad, 0.01 * torque / p.stiffness_nm_rad);
  // Let go, it comes back; slid over, it does not.
  run(plant, 1, none);
  EXPECT_LT(std::abs(plant.load_rad()), 0.02 * torque / (0.015 / 0.0126));
  run(plant, 0.05, [](double) { return 0.03; });
  run(plant, 1, none);
  EXPECT_GT(plant.load_rad(), 0.05);
}

TEST(TwoMasses, NeverGainEnergyThatNobodyGave) {
  std::mt19937 random(23);
  std::uniform_real_distribution<double> share(0, 1);
  for (int k = 0; k < 200; ++k) {
    TwoMassParameters p = frictionless();
    p.stiffness_nm_rad *= std::pow(10, 3 * share(random) - 1);
    p.load_inertia_kg_m2 *= std::pow(10, 2 * share(random) - 1);
    p.damping_nm_s_rad = k % 3 == 0 ? 0 : 1e-3 * share(random);
    p.play_rad = k % 2 == 0 ? 0 : 0.01 * share(random);
    if (k % 5 != 0) {
      p.motor_friction = friction(0.02 * share(random), std::pow(10, -5 + 3 * share(random)));
      p.load_friction = friction(0.02 * share(random), std::pow(10, -5 + 3 * share(random)));
    }
    TwoMasses plant(p);
    const double dt = std::min(kStep, plant.largest_step_s()) * (0.1 + 1.9 * share(random));
    for (int i = 0; i < 40; ++i) plant.step({.motor_nm = 2 * share(random) - 1, .load_nm = 2 * share(random) - 1}, dt);
    double before = plant.energy_j();
    for (int i = 0; i < 4000; ++i) {
      plant.step({}, dt);
      const double now = plant.energy_j();
      ASSERT_LE(now, before * (1 + 1e-10) + 1e-18) << "case " << k << ", step " << i;
      before = now;
    }
  }
}

TEST(TwoMasses, KeepTheirEnergyWhereNothingTakesIt) {
  TwoMassParameters p = frictionless();
  p.play_rad = 0.004;
  TwoMasses plant(p);
  run(plant, 0.002, [](double) { return 0.1; });
  const double energy = plant.energy_j();
  run(plant, 2, none);
  EXPECT_NEAR(plant.energy_j(), energy, 1e-9 * energy);
}

/// Amplitude of the load's motion in the last second, under a loop that closes over the load at 1 kHz.
template <typename Step>
double swings_with(const Step& step) {
  constexpr double kCycle = 1e-3, kP = 0.35, kI = 11, kD = 3.9e-3;
  double integral = 0, before = 0, most = 0, x = 0;
  for (int i = 0; i < 4000; ++i) {
    integral += x * kCycle;
    const double nm = -(kP * x + kI * integral + kD * (x - before) / kCycle) + (i < 20 ? 0.02 : 0);
    before = x;
    x = step(nm, kCycle);
    if (i >= 3000) most = std::max(most, std::abs(x));
  }
  return most;
}

TEST(TwoMasses, SwingWithPlayInALoopAsLargeAsThePlayIs) {
  const auto swings = [](double play) {
    TwoMassParameters p = frictionless();
    p.damping_nm_s_rad = 4e-4;
    p.play_rad = play;
    TwoMasses plant(p);
    return swings_with([&](double nm, double cycle) {
      run(plant, cycle, [nm](double) { return nm; });
      return plant.load_rad();
    });
  };
  EXPECT_LT(swings(0), 1e-9) << "without play the loop settles";
  const double once = swings(0.006);
  EXPECT_GT(once, 0.001);
  EXPECT_NEAR(swings(0.012), 2 * once, 0.05 * once) << "nothing in it but the play has a length";
  TwoMassParameters p = frictionless();
  p.damping_nm_s_rad = 4e-4;
  p.play_rad = 0.006;
  Reference truth(p);
  const double true_swing = swings_with([&](double nm, double cycle) {
    truth.run(cycle, 5e-6, [nm](double) { return nm; });
    return truth.state[1];
  });
  EXPECT_NEAR(once, true_swing, 0.05 * true_swing);
}

TEST(TwoMasses, HoldTheMotorWhileTheBrakeIsClosed) {
  TwoMassParameters p = frictionless();
  p.damping_nm_s_rad = 4e-4;
  p.brake = {.coulomb_nm = 0.318,
             .static_nm = 0.318,
             .presliding_rad = 1e-3,
             .elastic_share = 0.9,
             .stribeck_rad_s = 1.26,
             .damping_nm_s_rad = 0.07};
  TwoMasses plant(p);
  for (int i = 0; i < 40000; ++i) plant.step({.load_nm = -0.0937, .braked = true}, kStep);
  EXPECT_NEAR(plant.motor_rad(), -0.0937 / 318, 2e-5);
  EXPECT_NEAR(plant.load_rad(), -0.0937 / 318 - 0.0937 / p.stiffness_nm_rad, 5e-5);
  EXPECT_LT(std::abs(plant.load_rad_s()), 1e-5);
  for (int i = 0; i < 40000; ++i) plant.step({.load_nm = -0.0937}, kStep);
  EXPECT_LT(plant.load_rad(), -100) << "and no longer";
}

// Whatever pulls, and through whatever play: what hangs at its zero stays there, and nothing swings.
TEST(TwoMasses, StandAtTheirZeroUnderTheWeightItWasSetWith) {
  std::mt19937 random(41);
  std::uniform_real_distribution<double> share(-1, 1);
  for (int k = 0; k < 50; ++k) {
    TwoMassParameters p = frictionless();
    p.play_rad = k % 2 == 0 ? 0 : 0.01 * (1 + share(random));
    p.weight_nm = 0.1 * share(random);
    TwoMasses plant(p);
    const auto hold = [&] {
      for (int i = 0; i < 4000; ++i) plant.step({.motor_nm = p.weight_nm, .load_nm = -p.weight_nm}, kStep);
    };
    hold();
    ASSERT_NEAR(plant.motor_rad(), 0, 1e-9) << "case " << k << ", weight " << p.weight_nm << ", play " << p.play_rad;
    ASSERT_NEAR(plant.load_rad(), 0, 1e-9);
    const double angle = 100 * share(random);
    plant.put_at(angle);
    hold();
    ASSERT_NEAR(plant.motor_rad(), angle, 1e-9);
    ASSERT_NEAR(plant.load_rad(), angle, 1e-9);
    // The springs' energy is that of the weight, and nothing moves.
    const double wound = p.weight_nm * p.weight_nm / p.stiffness_nm_rad / 2;
    ASSERT_NEAR(plant.energy_j(), wound, 1e-9 * wound);
  }
}

TEST(TwoMasses, RestOnAPartThatPushesBackAndNeverPulls) {
  TwoMassParameters p = frictionless();
  p.damping_nm_s_rad = 4e-4;
  const PlantContact part{.stiffness_nm_rad = 0.63, .damping_nm_s_rad = 6e-4, .surface_rad = -1};
  TwoMasses plant(p);
  double lowest = 0;
  for (int i = 0; i < 80000; ++i) {
    plant.step({.load_nm = -0.02, .contact = part}, kStep);
    lowest = std::min(lowest, plant.load_rad());
  }
  EXPECT_LT(lowest, -1.05) << "it came with a blow";
  EXPECT_NEAR(plant.load_rad(), -1 - 0.02 / 0.63, 1e-3);
  EXPECT_NEAR(part.torque_nm(plant.load_rad(), plant.load_rad_s()), 0.02, 1e-3);
  for (int i = 0; i < 400; ++i) plant.step({.load_nm = 0.05, .contact = part}, kStep);
  EXPECT_GT(plant.load_rad_s(), 10) << "nothing holds it back";
}

}  // namespace
