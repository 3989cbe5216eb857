#include "gateway/chatter/cut_in_time.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

constexpr double kLeastDirection = 1e-9;  ///< of a direction's weight
/// Modes so many times stiffer than the softest limit nothing, and would want many steps: a beam's second is 39 times
/// so.
constexpr double kStiff = 10;
constexpr double kStepsASwing = 24;
constexpr int kRounds = 3;
constexpr double kLeastSteps = 48;  ///< from tooth to tooth
/// Looked at so long: the slowest swings so often, and so many teeth pass.
constexpr double kSwings = 60;
constexpr double kLeastTeeth = 12, kMostTeeth = 400;
constexpr double kMostWork = 3e5;  ///< steps of all oscillators: some ten milliseconds
constexpr double kBoundless = 1e60;
constexpr int kHalvings = 6;

/// One step of an oscillator, exact while the force on it is held.
struct Step {
  Eigen::Matrix2d free;
  Eigen::Vector2d forced;
};

Step step_of(double omega, double damping, double gain, double dt) {
  const double decay = damping * omega, damped = omega * std::sqrt(1 - damping * damping);
  const double e = std::exp(-decay * dt), c = std::cos(damped * dt), s = std::sin(damped * dt);
  Step step;
  step.free << e * (c + decay / damped * s), e * s / damped,  //
      -e * omega * omega / damped * s, e * (c - decay / damped * s);
  step.forced << gain / (omega * omega) * (1 - step.free(0, 0)), gain * e * s / damped;
  return step;
}

}  // namespace

CutInTime::CutInTime(std::span<const Eigen::Matrix3d> over_pitch_n_mm, std::span<const VibrationMode> modes)
    : over_pitch_(over_pitch_n_mm.begin(), over_pitch_n_mm.end()) {
  for (const Eigen::Matrix3d& each : over_pitch_) strongest_n_mm_ = std::max(strongest_n_mm_, each.norm());
  double softest = std::numeric_limits<double>::infinity();
  for (const VibrationMode& mode : modes) softest = std::min(softest, mode.stiffness_n_mm);
  for (const VibrationMode& mode : modes) {
    if (mode.stiffness_n_mm > kStiff * softest) continue;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(mode.directions);
    const double omega = 2 * pi * mode.frequency_hz;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const double weight = solved.eigenvalues()[i];
      if (weight < kLeastDirection) continue;
      oscillators_.push_back({.omega_rad_s = omega,
                              .damping_ratio = mode.damping_ratio,
                              .gain = omega * omega / mode.stiffness_n_mm,
                              .along = std::sqrt(weight) * solved.eigenvectors().col(i)});
    }
  }
}

CutInTime::Length CutInTime::length_of(double share, double tooth_period_s) const {
  const auto swings = [&](double omega) { return omega / (2 * pi) * tooth_period_s; };
  double slowest = std::numeric_limits<double>::infinity(), fastest = 0;
  for (const Oscillator& one : oscillators_) {
    slowest = std::min(slowest, one.omega_rad_s);
    // Material that holds the tool makes it swing faster.
    fastest = std::max(fastest, std::sqrt(one.omega_rad_s * one.omega_rad_s + share * strongest_n_mm_ * one.gain));
  }
  const double steps = std::max(kLeastSteps, std::ceil(kStepsASwing * swings(fastest)));
  const double teeth = std::clamp(std::floor(kSwings / swings(slowest)), kLeastTeeth, kMostTeeth);
  const bool short_enough = steps * teeth * static_cast<double>(oscillators_.size()) <= kMostWork;
  return short_enough ? Length{static_cast<int>(steps), static_cast<int>(teeth)} : Length{};
}

bool CutInTime::can_tell(double share, double tooth_period_s) const {
  return !oscillators_.empty() && !over_pitch_.empty() && length_of(2 * share, tooth_period_s).steps > 0;
}

bool CutInTime::grows(double share, double tooth_period_s) const {
  if (oscillators_.empty() || over_pitch_.empty()) return false;
  const Length length = length_of(share, tooth_period_s);
  const int steps = length.steps, teeth = length.teeth;
  if (steps == 0) return false;
  std::vector<Step> step;
  step.reserve(oscillators_.size());
  for (const Oscillator& one : oscillators_) {
    step.push_back(step_of(one.omega_rad_s, one.damping_ratio, one.gain, tooth_period_s / steps));
  }
  std::vector<Eigen::Vector2d> states(oscillators_.size(), {1, 0}), next(states);
  std::vector<Vector3d> waves(static_cast<std::size_t>(steps), Vector3d::Zero());  ///< of the tooth before
  const auto change = [&](int at) -> Eigen::Matrix3d {
    const auto part = static_cast<std::size_t>(at) * over_pitch_.size() / static_cast<std::size_t>(steps);
    return share * over_pitch_[part];
  };
  const auto tip = [&](const std::vector<Eigen::Vector2d>& of) {
    Vector3d sum = Vector3d::Zero();
    for (std::size_t i = 0; i < of.size(); ++i) sum += of[i][0] * oscillators_[i].along;
    return sum;
  };
  const auto advance = [&](const Vector3d& force) {
    for (std::size_t i = 0; i < states.size(); ++i) {
      next[i] = step[i].free * states[i] + step[i].forced * oscillators_[i].along.dot(force);
    }
  };
  double early = 0, late = 0;
  for (int tooth = 0; tooth < teeth; ++tooth) {
    for (int at = 0; at < steps; ++at) {
      const auto here = static_cast<std::size_t>(at), after = (here + 1) % waves.size();
      const Vector3d place = tip(states), force = change(at) * (place - waves[here]);
      waves[here] = place;
      // The force over the step is the mean of those at its ends. Fewer rounds give swings energy that nobody put in.
      const Eigen::Matrix3d then = change((at + 1) % steps);
      advance(force);
      for (int round = 0; round < kRounds; ++round) advance((force + then * (tip(next) - waves[after])) / 2);
      states.swap(next);
      const double swing = place.norm();
      if (swing > kBoundless) return true;
      if (tooth >= teeth / 4 && tooth < teeth / 2) early = std::max(early, swing);
      if (tooth >= teeth * 3 / 4) late = std::max(late, swing);
    }
  }
  return late > early;
}

double CutInTime::limit(double near, double tooth_period_s) const {
  double steady = near / 2, grown = near * 2;
  if (grows(steady, tooth_period_s)) return steady;
  if (!grows(grown, tooth_period_s)) return grown;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = std::sqrt(steady * grown);
    (grows(middle, tooth_period_s) ? grown : steady) = middle;
  }
  return std::sqrt(steady * grown);
}

}  // namespace rmac::gateway
