#pragma once

#include <array>
#include <memory>
#include <span>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

/// A point of a path in joint space with derivatives by path length: `d[k][j]` is the k-th derivative of joint j, in mm
/// or deg.
struct JointPoint {
  std::array<std::array<double, kMaxJoints>, 4> d;
};

/// From tool poses in the part frame to joints, under frames and kinematics that many moves share. Immutable.
class PoseToJoints {
 public:
  PoseToJoints(const Frames& frames, std::shared_ptr<const Kinematics> kinematics);

  [[nodiscard]] const Frames& frames() const noexcept { return frames_; }
  [[nodiscard]] const Kinematics& kinematics() const noexcept { return *kinematics_; }
  [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }

  /// Joints, and their derivatives by path length up to `order` (0 to 3), at a point of a curve of poses, which may
  /// have the rotary joints as further coordinates (see `Curve`). `seed`: joints nearby, joint_count() values.
  /// Real-time safe.
  [[nodiscard]] KinematicsStatus evaluate(const CurvePoint& curve, std::size_t dimension, int order,
                                          std::span<const double> seed, JointPoint& point) const noexcept;
  /// d[1] to d[3] of `point` alone, at a curve's point with derivatives up to the third, where they do not depend on
  /// where the joints are. False where they do: then nothing is done. Real-time safe.
  [[nodiscard]] bool derivatives(const CurvePoint& curve, JointPoint& point) const noexcept;
  /// Joints follow poses linearly: their derivatives depend on where the curve goes alone.
  [[nodiscard]] bool linear() const noexcept { return coordinates_ > 0; }
  /// On a curve by the length of the tip's path, a joint moves by at most this much a mm; infinite where it depends on
  /// where the joints are.
  [[nodiscard]] double largest_rate(std::size_t joint) const noexcept;
  /// The pose in the part frame that joints give; no numbers where they have none.
  [[nodiscard]] ToolPose pose(std::span<const double> joints) const noexcept;

 private:
  [[nodiscard]] KinematicsStatus solve(const CurvePoint& curve, std::size_t dimension, const ToolPose& wanted,
                                       int order, std::span<const double> seed, JointPoint& point) const noexcept;
  template <std::size_t kOrder>
  void apply_rates(const CurvePoint& curve, JointPoint& point) const noexcept;

  Frames frames_;
  std::shared_ptr<const Kinematics> kinematics_;
  std::size_t joint_count_;
  /// Where the Jacobian is the same everywhere and has full rank: d(joint)/d(pose in the part frame), a column each
  /// for those coordinates of the pose that move a joint; slides alone follow the tip only.
  std::array<std::array<double, kMaxJoints>, 6> rates_{};
  std::size_t coordinates_ = 0;  ///< columns of it; 0: the Jacobian changes
};

}  // namespace rmac
