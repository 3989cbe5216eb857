#pragma once

#include <cstddef>
#include <span>

#include "rmac/motion/joint.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac {

enum class KinematicsStatus {
  Ok,
  OutOfReach,  ///< no joint vector gives this pose (too far, or off the plane of a two-axis machine)
  Singular,    ///< the Jacobian loses rank here, so the joint velocities are not determined
};

/// Port: joints ↔ tool. The machine frame is fixed to the link that holds the part; joints are mm or degrees, in the
/// order of `device.json`. `tool` is the pose of the tool tip on the tool interface (`SetToolInterfaceFrame`).
/// Stateless and const: the planner and the servo thread call the same object at the same time. Real-time safe: no
/// allocation.
class Kinematics {
 public:
  virtual ~Kinematics() = default;
  [[nodiscard]] virtual std::size_t joint_count() const noexcept = 0;
  /// What joint number `joint` does in this geometry; a mechanism whose device says otherwise is refused.
  [[nodiscard]] virtual JointType joint_type(std::size_t joint) const noexcept = 0;

  /// Tool pose in the machine frame. `joints`: joint_count() values. Total: every joint vector has a pose.
  virtual void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept = 0;

  /// Joints that give `pose`; of several solutions the one whose rotary joints are nearest to `seed`, whole turns
  /// included. A joint that the pose leaves free (C while the tool stands along it) keeps its seed. Joint limits are
  /// not this function's business.
  [[nodiscard]] virtual KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                                 std::span<double> joints) const noexcept = 0;

  /// Row-major 6 x n: d(tip x, y, z, axis i, j, k) / d(joint). Rotary columns are per degree.
  virtual void jacobian(std::span<const double> joints, const Frame& tool,
                        std::span<double> jacobian) const noexcept = 0;

  /// The pole, where there is one: the direction of the tool axis, in the machine frame and in either sense, along
  /// which it leaves a rotary joint free, and close to which that joint turns fast. The planner leads paths past it.
  [[nodiscard]] virtual bool pole(Vector& /*axis*/) const noexcept { return false; }

  /// Every solution, each within half a turn of `seed` in its rotary joints, the nearest first, one after the other in
  /// `joints`; as many as fit. How many there are: 0 where the pose is out of reach. A geometry with a single solution
  /// need not say more than its inverse.
  [[nodiscard]] virtual std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                              std::span<double> joints) const noexcept {
    return inverse(pose, tool, seed, joints.first(joint_count())) == KinematicsStatus::Ok ? 1 : 0;
  }

  /// The Jacobian is the same at all joints: slides alone, each along a direction of its own. Spares the planner a
  /// quarter of its work (bench_motion's planning row: 23 500 lines a second without, 31 100 with).
  [[nodiscard]] virtual bool constant_jacobian() const noexcept { return false; }
};

}  // namespace rmac
