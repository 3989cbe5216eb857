#pragma once

#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "rmac/motion/servo/learned_path.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/setpoint.hpp"
#include "servo/joints/index_set.hpp"

namespace rmac {

/// What is added to joints' setpoints, for their laws alone, where a program is repeated of which something was
/// learned. It goes by a quarter of its bound in a millisecond at most, and where the path begins, ends or jumps, what
/// is missing to the offset before goes away on a critically damped way. Real-time safe but for its making.
class LearnedOffsets {
 public:
  /// `joints` must outlive it.
  LearnedOffsets(std::span<const ServoJoint> joints, double period_s);

  /// Another path, or none; `path` is left with the one of before.
  void exchange(std::shared_ptr<const LearnedPath>& path) noexcept {
    path_.swap(path);
    cursor_ = {};
  }
  /// One cycle. `follows`: a program's path is followed, at this place. Joints whose law does not control
  /// them have none.
  void step(const Setpoint& at, bool follows, IndexSet controlled) noexcept;

  /// What to add, mm or degrees, and its rate of change.
  [[nodiscard]] double position(std::size_t joint) const noexcept { return joints_[joint].offset; }
  [[nodiscard]] double velocity(std::size_t joint) const noexcept { return joints_[joint].rate; }

  /// Largest offset of a joint that makes sense; 0: its drive closes its loop itself, and takes none.
  [[nodiscard]] static double bound(const ServoJoint& joint, bool follows_itself) noexcept {
    return follows_itself || joint.law == nullptr ? 0 : kLargestPart * joint.max_following_error;
  }
  static constexpr double kLargestPart = 0.25;  ///< of what a joint may fall behind
  static constexpr double kFading = 50;         ///< 1/s: of both poles
  static constexpr double kFastest = 250;       ///< 1/s: bounds a second, whatever the path says: 40 Hz between them
  static constexpr double kFaded = 1e-12;       ///< mm or degrees, and of them a second

 private:
  struct Joint {
    double bound = 0;
    double offset = 0, rate = 0;
    double wanted = 0;               ///< as it was learned
    double rest = 0, rest_rate = 0;  ///< beside that, on its way to nothing
  };
  void go_on(Joint& joint, double wanted, bool jumps) const noexcept;

  std::span<const ServoJoint> parts_;
  double period_s_;
  std::vector<Joint> joints_;
  std::shared_ptr<const LearnedPath> path_;
  LearnedPath::Cursor cursor_;
  bool followed_ = false;
};

}  // namespace rmac
