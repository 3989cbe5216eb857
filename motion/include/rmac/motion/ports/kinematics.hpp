#pragma once

#include <cstddef>
#include <limits>
#include <optional>
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

  /// Tool pose in the machine frame. `joints`: joint_count() values. Where they have no pose (`has_pose`), what it
  /// gives is not used.
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

  /// Whether joints have a pose. Those of a chain always have one; the carriages of a delta may stand where its arms do
  /// not meet. What `inverse` and `solutions` give has a pose. Joints are not led to where they have none.
  [[nodiscard]] virtual bool has_pose(std::span<const double> /*joints*/) const noexcept { return true; }

  /// Joints do not stand one on the other: a slide moves the tool by another way than its own, and may turn it.
  [[nodiscard]] virtual bool parallel() const noexcept { return false; }

  /// The joint that a pose leaves over: tip and axis are five numbers, and a robot has six joints. `inverse` and
  /// `solutions` leave it where the seed has it, always, and find the others.
  [[nodiscard]] virtual std::optional<std::size_t> free_joint() const noexcept { return std::nullopt; }

  /// Whether the inverse knows how to lead this tool. Moves of a tool that it does not take are refused.
  [[nodiscard]] virtual bool takes(const Frame& /*tool*/) const noexcept { return true; }

  /// The Jacobian is the same at all joints: slides alone, each along a direction of its own. Spares the planner a
  /// quarter of its work (bench_motion's planning row: 23 500 lines a second without, 31 100 with).
  [[nodiscard]] virtual bool constant_jacobian() const noexcept { return false; }
};

/// The tool's pose in the machine frame; no numbers where the joints have none. Real-time safe.
[[nodiscard]] inline ToolPose pose_of(const Kinematics& kinematics, std::span<const double> joints,
                                      const Frame& tool) noexcept {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  ToolPose pose{{kNone, kNone, kNone}, {kNone, kNone, kNone}};
  if (kinematics.has_pose(joints)) kinematics.forward(joints, tool, pose);
  return pose;
}

}  // namespace rmac
