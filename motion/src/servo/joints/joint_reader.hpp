#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/measured_efforts.hpp"
#include "servo/joints/transmission.hpp"

namespace rmac {

/// Where the joints are and how fast, as their drives show it after what the mechanics do wrong; what their motors push
/// with, and what their force sensors measure. mm or degrees, N or N·m. Real-time safe but for its making.
class JointReader {
 public:
  /// All must outlive it. It moves the corrections of `transmission` on, cycle by cycle.
  JointReader(const ServoLoopParts& parts, const Wiring& wiring, Transmission& transmission);

  /// One cycle. `live`: joints under control, whose `velocity_set` says which flank of a backlash carries. `steady`:
  /// those of them all of whose drives answer; the counter of another one may change by more than its shaft.
  void read(std::span<const double> shafts, std::span<const double> shaft_velocities, IndexSet live, IndexSet steady,
            std::span<const double> velocity_set) noexcept;
  /// Before `read` in a cycle that comes late: the drives have gone on for longer than a cycle, and no step of it is
  /// one.
  void forget_steps() noexcept {
    for (Shown& shown : shown_) shown.history = 0;
  }
  /// Where there are no drives: the joints are where they are wanted.
  void reflect(std::span<const double> position_set, std::span<const double> velocity_set) noexcept;

  /// Where joints are whose loads stand at these angles of the shafts. A load is behind the play, so that no backlash
  /// is in it; what a screw's pitch does wrong is between load and joint.
  [[nodiscard]] std::array<double, kMaxJoints> at_loads(std::span<const double> loads_rad) const noexcept;

  [[nodiscard]] std::span<const double> positions() const noexcept { return {position_.data(), joints_.size()}; }
  [[nodiscard]] const std::array<double, kMaxJoints>& position() const noexcept { return position_; }
  [[nodiscard]] const std::array<double, kMaxJoints>& velocity() const noexcept { return velocity_; }
  [[nodiscard]] const std::array<double, kMaxJoints>& force() const noexcept { return force_; }
  /// What the joint's motors push it with; none where their drives do not tell.
  [[nodiscard]] std::optional<double> measured_effort(std::size_t joint) const noexcept {
    return efforts_.told(joint) ? std::optional(efforts_[joint]) : std::nullopt;
  }
  /// Change of the joint's step from the last cycle to this one, before corrections.
  [[nodiscard]] double jump(std::size_t joint) const noexcept { return shown_[joint].jump; }
  /// Its last step, where drives answered in both cycles.
  [[nodiscard]] std::optional<double> step(std::size_t joint) const noexcept { return shown_[joint].step; }
  /// With this cycle's step it was no faster than a moment before, either way: what made a jump of it may be a stop.
  [[nodiscard]] bool may_stop(std::size_t joint) const noexcept { return shown_[joint].may_stop; }

 private:
  void read_jump(std::size_t joint, double position, bool steady) noexcept;

  std::span<const ServoJoint> joints_;
  double period_s_;
  double fades_;  ///< share of a step that is left of it in the next cycle
  Transmission& transmission_;
  MeasuredEfforts efforts_;
  std::array<double, kMaxJoints> position_{}, velocity_{};
  std::array<double, kMaxJoints> force_{};
  /// What a joint's positions show, before corrections.
  struct Shown {
    double last = 0, before = 0;  ///< positions one and two cycles ago
    std::uint8_t history = 0;     ///< how many of the two there are
    double jump = 0;
    std::optional<double> step{};
    double fastest = 0;  ///< step, lately
    bool may_stop = false;
  };
  std::array<Shown, kMaxJoints> shown_{};
};

}  // namespace rmac
