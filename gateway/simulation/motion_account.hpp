#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "gateway/state/cycle_sample.hpp"
#include "rmac/motion/move.hpp"
#include "rmac/motion/path_segment.hpp"
#include "rmac/sdk/device_object.hpp"

namespace rmac::gateway {

/// What the motion of a program asks of a machine: each joint's peaks, and the limit that each cycle was nearest to.
/// Fed with setpoints, cycle by cycle; a joint's jerk is the change of its acceleration from one cycle to the next.
class MotionAccount {
 public:
  /// mm or deg, and s.
  struct Joint {
    std::string name;
    double peak_velocity = 0, peak_acceleration = 0, peak_jerk = 0;
  };
  /// Time for which a limit was the nearest.
  struct Share {
    std::string limit;  ///< "feed", "path acceleration", "X velocity", "X acceleration", "X jerk", …, "none"
    double time_s = 0;
  };
  /// The nearest limit rules a cycle from this part of its bound on; below, none does.
  static constexpr double kRules = 0.5;

  explicit MotionAccount(double period_s);

  /// Limits from now on. A joint keeps its name, whichever mechanism moves it.
  void mechanism(const sdk::DeviceObject& device);
  /// A move has been added to those that are not done.
  void queued(const Move& move, std::span<const std::shared_ptr<const PathSegment>> segments);
  /// The first of the moves that are not done is done. Gives the limit that ruled it for the longest time, as in
  /// `Share`; empty where it did not move.
  [[nodiscard]] std::string move_done();
  void cycle(const CycleSample& sample, double override_percent);
  /// The limit that rules the last cycle, as in `Share`; empty where nothing moves.
  [[nodiscard]] std::string rules_now() const { return rules_ ? limit_name(*rules_) : std::string(); }

  [[nodiscard]] const std::vector<Joint>& joints() const noexcept { return joints_; }
  /// Limits that ruled for any time, the longest first; together the time in motion.
  [[nodiscard]] std::vector<Share> shares() const;
  /// The tool tip's way along the moves that were queued, as programmed; without jogs.
  [[nodiscard]] double length_mm() const noexcept { return length_mm_; }

 private:
  struct Bounds {
    std::size_t joint = 0;  ///< in joints_
    double velocity = 0, acceleration = 0, jerk = 0;
  };
  /// What a move allows along its path; 0: as much as the joints can.
  struct PathBounds {
    double feed_mm_s = 0, rise_mm_s2 = 0, fall_mm_s2 = 0;
    double joint_fraction = 0;  ///< in joint space: the share of the joints' speed limits
  };
  static constexpr std::size_t kNone = 0, kFeed = 1, kPathAcceleration = 2, kJointLimits = 3;

  void count(const CycleSample& sample, double override_percent);
  [[nodiscard]] std::string limit_name(std::size_t limit) const;
  [[nodiscard]] double part_of_feed(const CycleSample& sample, const PathBounds& path, double override_factor) const;

  double period_s_;
  double max_feed_mm_s_ = 0;
  std::vector<Joint> joints_;
  std::vector<Bounds> bounds_;  ///< those of the mechanism in force, joint by joint
  std::vector<double> time_s_;  ///< none, feed, path acceleration, then velocity, acceleration and jerk of each joint
  std::vector<double> time_in_move_s_;  ///< the same, in the move that is under way
  std::deque<PathBounds> path_;         ///< those of the moves that are not done
  std::vector<double> jerk_;            ///< in the cycle
  std::vector<double> acceleration_;    ///< in the cycle before
  std::optional<std::size_t> rules_;    ///< the last cycle
  double length_mm_ = 0, feed_before_mm_s_ = 0;
};

}  // namespace rmac::gateway
