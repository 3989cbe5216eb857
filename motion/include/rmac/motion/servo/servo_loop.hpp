#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "rmac/motion/error.hpp"
#include "rmac/motion/joint.hpp"
#include "rmac/motion/servo/servo_fault.hpp"

namespace rmac {

class LearnedPath;
struct ServoBus;
struct ServoCommand;
struct ServoHandover;
struct ServoLoopParts;
struct ServoReport;

/// One servo cycle of one mechanism, as a function. Built off the servo thread; then all members are the servo
/// thread's, and real-time safe: no allocation, lock or exception.
///
/// Order of a cycle: exchange with each bus (the words made in the cycle before go out, so a drive acts on a
/// measurement one cycle after it was taken); counts → shaft → joint; setpoint; servo law; effort → shaft → torque
/// word.
///
/// Joint velocity comes from the last three positions, (3 x0 - 4 x1 + x2) / (2 period): without lag as long as the
/// acceleration is steady, where a plain difference would be half a period late, which a D term pays for in phase. Its
/// noise is at most four encoder counts a period; a law may filter it further.
///
/// Joint positions are those of the joint, after pitch errors and backlash; efforts pass the joint's filters on their
/// way to the map.
///
/// After a cycle whose report says that it does not follow, the follower must be put at `hold_position()`
/// (`PlanFollower::hold_at`), so that engaging does not jump.
class ServoLoop {
 public:
  /// Checks that the parts fit together; the error says which do not. Off the servo thread.
  [[nodiscard]] static Expected<std::unique_ptr<ServoLoop>> create(ServoLoopParts parts);
  ~ServoLoop();
  ServoLoop(const ServoLoop&) = delete;
  ServoLoop& operator=(const ServoLoop&) = delete;

  [[nodiscard]] std::size_t joint_count() const noexcept;  ///< of the kinematics
  [[nodiscard]] std::size_t joint_count_with_held() const noexcept;
  [[nodiscard]] const ServoLoopParts& parts() const noexcept;
  /// The bus that a fault of a bus names by `index`; nullptr where there is none.
  [[nodiscard]] const ServoBus* bus(std::size_t index) const noexcept;

  /// Takes over from another loop between two cycles, before this one's first cycle. Drives that both have stay
  /// operational, with their setpoint and torque; drives of the same buses that this loop does not have go off.
  void engage(const ServoHandover& previous) noexcept;
  [[nodiscard]] ServoHandover handover() const noexcept;

  void cycle(const ServoCommand& command, ServoReport& report) noexcept;

  /// How far a joint under velocity control is off the plan, mm or degrees; 0 of other joints.
  [[nodiscard]] double slipped(std::size_t joint) const noexcept;
  /// What the joint's loop controls from the next cycle on, at rest or in motion: its position or its velocity. A joint
  /// that has not slipped goes on where it is, without a step.
  void set_control_method(std::size_t joint, ControlMethod method) noexcept;

  /// What was learned of the program that follows, or nothing, at rest or in motion: no setpoint steps. `path` is left
  /// with what was there before.
  void exchange_learned(std::shared_ptr<const LearnedPath>& path) noexcept;
  /// Largest offset of the joint that can be learned, mm or degrees; 0: none, as its drive closes its loop itself.
  [[nodiscard]] double learned_bound(std::size_t joint) const noexcept;
  /// So many cycles ago was the joint where it tells that it is.
  [[nodiscard]] int answer_delay(std::size_t joint) const noexcept;

  [[nodiscard]] ServoState state() const noexcept;
  /// Where the loop holds its joints: the last setpoint, or the measured position where there is no torque.
  /// joint_count_with_held() values, the kinematic joints first; zero before the first cycle unless `engage` was
  /// called.
  [[nodiscard]] std::span<const double> hold_position() const noexcept;

 private:
  struct Impl;
  explicit ServoLoop(std::unique_ptr<Impl> impl) noexcept;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rmac
