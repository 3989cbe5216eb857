#pragma once

#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <vector>

#include "rmac/modules/chain_kinematics.hpp"
#include "rmac/motion/follower/plan_follower.hpp"
#include "rmac/motion/path_builder.hpp"
#include "rmac/motion/planner.hpp"

namespace rmac::test {

inline constexpr Vector kUp{0, 0, 1};

inline PlannerModel mill(double jerk = 10000) {
  PlannerModel model;
  model.kinematics = std::make_shared<modules::ChainKinematics>(modules::cartesian(3));
  for (const char* name : {"X", "Y", "Z"})
    model.joints.push_back({name, JointType::Linear, JointLimitType::Limited, -50, 50, 200, 1000, jerk});
  return model;
}

/// Planner and follower in lockstep: before each cycle the planner does all it can, as it does behind the virtual
/// clock.
class PlannerBench {
 public:
  explicit PlannerBench(PlannerModel model)
      : builder(model),
        planner(model, channel_),
        follower_(channel_, model.joints, model.period_s),
        joints_(model.joints) {
    follower_.hold_at(std::vector<double>(model.joints.size(), 0.0));
  }

  [[nodiscard]] Expected<> queue(const Move& move) {
    auto segments = builder.build(move);
    if (!segments) return tl::unexpected(segments.error());
    planner.add(std::move(*segments));
    return {};
  }

  void cycle() {
    while (!planner.idle(progress())) planner.step(progress());
    servo_cycle();
    planner.step(progress());
  }

  /// The servo loop goes on for `cycles` while the planner works on what it knew before.
  void cycles_with_late_planner(int cycles) {
    const ServoProgress known = progress();
    for (int i = 0; i < cycles; ++i) servo_cycle();
    planner.step(known);
  }

  /// Cycles in which the planner does nothing any more: it hangs.
  void cycles_without_planner(int cycles) {
    for (int i = 0; i < cycles; ++i) servo_cycle();
  }
  /// The way back from where the joints rest.
  double turn_back(double distance_mm) {
    const auto way = planner.turn_back(distance_mm, {record.back().position.data(), joints_.size()});
    return way ? *way : -1;
  }
  [[nodiscard]] PlanFollower& follower() { return follower_; }

  /// Runs until the machine rests and nothing is left to plan; false when it has not after `most` cycles.
  bool run(std::int64_t most = 2000000) {
    for (std::int64_t i = 0; i < most; ++i) {
      cycle();
      if (!record.back().moving && planner.idle(progress()) && planner.at_rest(progress())) return true;
    }
    return false;
  }

  [[nodiscard]] ServoProgress progress() const {
    return {cycle_, follower_.accepted_plan(), follower_.last_refused(), follower_.departure()};
  }
  [[nodiscard]] std::uint64_t refused() const { return follower_.last_refused(); }

  struct Peaks {
    double velocity = 0, acceleration = 0, jerk = 0;  ///< as parts of the joint limits
    std::size_t jerk_cycle = 0;
  };
  /// Largest first, second and third differences of the recorded joint positions, as parts of the limits.
  [[nodiscard]] Peaks peaks() const {
    Peaks peaks;
    const double dt = 0.001;
    for (std::size_t i = 3; i < record.size(); ++i) {
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        const double a = record[i - 3].position[j], b = record[i - 2].position[j], c = record[i - 1].position[j],
                     d = record[i].position[j];
        peaks.velocity = std::max(peaks.velocity, std::abs(d - c) / dt / joints_[j].max_speed);
        peaks.acceleration =
            std::max(peaks.acceleration, std::abs(d - 2 * c + b) / (dt * dt) / joints_[j].max_acceleration);
        const double jerk = std::abs(d - 3 * c + 3 * b - a) / (dt * dt * dt) / joints_[j].max_jerk;
        if (jerk > peaks.jerk) peaks.jerk = jerk, peaks.jerk_cycle = i;
      }
    }
    return peaks;
  }
  [[nodiscard]] std::size_t moves_done() const {
    std::size_t done = 0;
    for (const Setpoint& setpoint : record) done += setpoint.moves_done;
    return done;
  }

  PathBuilder builder;

 private:
  void servo_cycle() {
    ++cycle_;
    Setpoint setpoint;
    follower_.sample(cycle_, setpoint);
    record.push_back(setpoint);
  }

  PlanChannel channel_;

 public:
  Planner planner;
  std::vector<Setpoint> record;

 private:
  PlanFollower follower_;
  std::vector<JointLimits> joints_;
  std::int64_t cycle_ = 0;
};

}  // namespace rmac::test
