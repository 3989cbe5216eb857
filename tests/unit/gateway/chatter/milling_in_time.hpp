#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "gateway/chatter/vibration_mode.hpp"
#include "gateway/forces/force_coefficients.hpp"
#include "gateway/forces/turn_forces.hpp"

namespace rmac::gateway::test {

/// One that swings along `d`, as VibrationMode has it.
struct Oscillator {
  double frequency_hz, damping_ratio, stiffness_n_mm;
  Eigen::Vector3d d;

  [[nodiscard]] VibrationMode mode() const {
    return {.frequency_hz = frequency_hz,
            .damping_ratio = damping_ratio,
            .stiffness_n_mm = stiffness_n_mm,
            .directions = d * d.transpose()};
  }
};

/// Straight teeth of a flat end mill.
struct StraightTeeth {
  int count;
  double depth_mm;
  Arc arc;
  ForceCoefficients material;
};

/// Swings a tool whose teeth meet the waves of the teeth before them, tooth by tooth and step by step, and tells by how
/// much it swings at the end against a while after the beginning: above 1 they grow. The linear part alone: no tooth
/// leaves the material, and what the feed gives is left out.
inline double growth(const StraightTeeth& teeth, std::span<const Oscillator> oscillators, double tooth_period_s,
                     int periods) {
  using std::numbers::pi;
  double highest_hz = 0;
  for (const Oscillator& one : oscillators) highest_hz = std::max(highest_hz, one.frequency_hz);
  constexpr double kStepsASwing = 60;
  constexpr int kLeastStepsAPeriod = 120;
  constexpr double kBoundless = 1e100;
  const auto steps =
      std::max(kLeastStepsAPeriod, static_cast<int>(std::ceil(kStepsASwing * highest_hz * tooth_period_s)));
  const double dt = tooth_period_s / steps;
  std::vector<Eigen::Vector3d> before(static_cast<std::size_t>(steps), Eigen::Vector3d::Zero());
  struct State {
    double q, v;
  };
  std::vector<State> now(oscillators.size(), {1e-3, 0}), next(now);
  // By the change of its place since the tooth before, N/mm, with the tool turned so far.
  const auto stiffness = [&](double turned) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (int tooth = 0; tooth < teeth.count; ++tooth) {
      double phi = std::fmod(turned + 2 * pi * tooth / teeth.count, 2 * pi);
      if (phi < teeth.arc.entry) phi += 2 * pi;
      if (phi > teeth.arc.exit) continue;
      const Eigen::Vector3d radial(std::sin(phi), std::cos(phi), 0), along(std::cos(phi), -std::sin(phi), 0);
      const ForceCoefficients& k = teeth.material;
      sum -= teeth.depth_mm * (k.ktc * along + k.krc * radial + k.kac * Eigen::Vector3d::UnitZ()) * radial.transpose();
    }
    return sum;
  };
  const auto tip = [&](const std::vector<State>& states) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < states.size(); ++i) sum += states[i].q * oscillators[i].d;
    return sum;
  };
  double early = 0, late = 0;
  const int window = periods / 5;
  for (int period = 0; period < periods; ++period) {
    for (int step = 0; step < steps; ++step) {
      const auto at = static_cast<std::size_t>(step), after = static_cast<std::size_t>((step + 1) % steps);
      const Eigen::Vector3d here = tip(now);
      const Eigen::Vector3d force = stiffness(2 * pi / teeth.count * step / steps) * (here - before[at]);
      const Eigen::Matrix3d then = stiffness(2 * pi / teeth.count * (step + 1) / steps);
      Eigen::Vector3d mean = force;
      for (int round = 0; round < 3; ++round) {
        for (std::size_t i = 0; i < now.size(); ++i) {
          const Oscillator& o = oscillators[i];
          const double w = 2 * pi * o.frequency_hz, push = w * w / o.stiffness_n_mm * o.d.dot(mean);
          // The trapezoidal rule, solved for the velocity.
          const double v =
              (now[i].v * (1 - o.damping_ratio * w * dt - w * w * dt * dt / 4) + dt * (push - w * w * now[i].q)) /
              (1 + o.damping_ratio * w * dt + w * w * dt * dt / 4);
          next[i] = {now[i].q + dt * (now[i].v + v) / 2, v};
        }
        // After the last step comes the first one's place, which this round has already put there.
        mean = (force + then * (tip(next) - before[after])) / 2;
      }
      before[at] = here;
      now = next;
      const double swing = here.norm();
      if (swing > kBoundless) return kBoundless;
      if (period >= window && period < 2 * window) early = std::max(early, swing);
      if (period >= periods - window) late = std::max(late, swing);
    }
  }
  return late / early;
}

}  // namespace rmac::gateway::test
