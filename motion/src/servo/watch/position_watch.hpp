#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "rmac/motion/machine_size.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/drives/shafts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/joints/index_set.hpp"
#include "servo/joints/late_answers.hpp"
#include "servo/joints/wiring.hpp"

namespace rmac {

/// Whether the positions that drives tell can be believed, and whether the machine still stands where it was left.
/// Real-time safe.
///
/// A reading is believed when the joint can have got there since the last one: within its bounds of velocity and jump,
/// in a cycle and those that were left unanswered. What no motion explains is not taken; the shaft stands where it was.
/// Behind that, and behind every answer that was lost, the position is in doubt, until the drive says the same by a
/// service of its own (`DriveCommand::read_position`), or, where its bus has none, three times on end. Only then is a
/// step taken, and where it is larger than `JointBounds::jump` the joint is not enabled before a reset, which costs it
/// its reference.
class PositionWatch {
 public:
  /// Both must outlive it.
  PositionWatch(const ServoLoopParts& parts, const Wiring& wiring);

  /// One cycle, once `shafts` are read: takes back what is not believed. `velocity`: of the joints, one cycle ago.
  /// `missed`: cycles that the appliance left out before this one, in which drives went on.
  void step(Shafts& shafts, std::span<const double> velocity, std::uint64_t missed = 0) noexcept;
  /// Joints all of whose drives answered in this cycle.
  [[nodiscard]] IndexSet answered() const noexcept { return answered_; }
  /// Steps of this cycle may be of more cycles than one, for the appliance was late.
  [[nodiscard]] bool late() const noexcept { return late_answers_.now() > 0; }
  /// Counters of these actuators jump while their drives look for home.
  void forget(IndexSet actuators) noexcept;
  /// They found it.
  void homed() noexcept;
  /// What another loop knew of a drive.
  struct Known {
    bool believed = false;    ///< its position was, at some time
    bool referenced = false;  ///< it found home, or needs none
    bool lost = false;        ///< its joint's reference is to be found again
  };
  [[nodiscard]] Known known(std::size_t actuator) const noexcept;
  /// `live`: it is under control, and so not in doubt.
  void take_over(std::size_t actuator, const Known& before, bool live) noexcept;
  /// All of them are taken over, with their counts.
  void go_on_from(const Shafts& shafts) noexcept;

  /// The position of this actuator is in doubt, and is to be read.
  [[nodiscard]] bool asks(std::size_t actuator) const noexcept { return has(doubtful_ & ~forgotten_, actuator); }
  /// It may be enabled. An answer that is missing now and then raises a doubt, and keeps nothing from that.
  [[nodiscard]] bool believes(std::size_t actuator) const noexcept { return !has(unsettled_, actuator); }
  /// Change of a joint's step, in this cycle, that was not believed; 0 where it was.
  [[nodiscard]] double jump(std::size_t joint) const noexcept { return has(jumped_, joint) ? joints_[joint].jump : 0; }

  /// Before power: joints, `live` ones apart, stand where they were left.
  void check_standing(IndexSet live, FaultSink& faults) noexcept;
  /// Before drives follow their first setpoints: `aims`, shaft angles, are where the joints stand.
  void check_aims(std::span<const double> aims, std::span<const double> shafts, IndexSet joints,
                  FaultSink& faults) noexcept;
  /// This joint is under control from now on.
  void engaged(std::size_t joint) noexcept;
  /// Whether the position of this joint jumped, or may have: where it is stopped so, whatever for, its reference is to
  /// be found again.
  void doubt_place(std::size_t joint, bool doubtful) noexcept {
    suspected_ = doubtful ? suspected_ | only(joint) : suspected_ & ~only(joint);
  }
  /// A reset left this fault: joints that were displaced, or jumped, count where they are, without their reference.
  /// Returns the joints of which nobody knows the place.
  IndexSet forgive(const ServoFault& fault) noexcept;
  /// Joints whose reference is to be found again.
  [[nodiscard]] IndexSet lost() const noexcept { return lost_; }

 private:
  using JointArray = std::array<double, kMaxJoints>;

  /// `now`: where the shafts put the joints.
  void judge(const JointArray& now, int late, Shafts& shafts) noexcept;
  void resolve(std::size_t actuator, Shafts& shafts) noexcept;
  void believe(std::size_t actuator, Shafts& shafts) noexcept;
  void doubt(std::size_t actuator, bool unsettles) noexcept;
  void notice_loss(std::size_t actuator) noexcept;
  [[nodiscard]] double difference(std::size_t joint, const Shafts& shafts, std::size_t actuator, std::int32_t one,
                                  std::int32_t other) const noexcept;
  [[nodiscard]] bool agree(const Shafts& shafts, std::size_t actuator, std::int32_t one, std::int32_t other,
                           int cycles) noexcept;
  [[nodiscard]] bool displaced(std::size_t joint) const noexcept;
  [[nodiscard]] double reach(std::size_t joint, int cycles) const noexcept;
  [[nodiscard]] JointArray joints_at(std::span<const double> shafts) const noexcept;
  [[nodiscard]] const DriveFeedback& told(std::size_t actuator) const noexcept {
    return parts_.actuators[actuator].bus->feedback[parts_.actuators[actuator].axis];
  }
  [[nodiscard]] bool referenced(std::size_t joint) const noexcept {
    return (wiring_.actuators_of(joint) & ~referenced_) == 0;
  }

  /// Of a drive whose position is in doubt, or whose last answers are missing.
  struct Doubt {
    std::uint32_t reads = 0;                  ///< that there were before
    int waited = 0;                           ///< cycles for the next
    int missed = 0;                           ///< answers, since the last one that counts
    int repeated = 0;                         ///< answers on end that agree with `candidate`
    std::optional<std::int32_t> candidate{};  ///< what the last of them told
  };

  /// Of a joint, in mm or degrees, before corrections.
  struct Place {
    double last = 0, step = 0;  ///< position, and its last step
    double jump = 0;            ///< change of the step that was not believed
    double displaced = 0;       ///< from where the joint was left
    double coasting = 0;        ///< way that it may have gone by itself when its drive fell silent
    double speed = 0;           ///< lately
  };

  const ServoLoopParts& parts_;
  const Wiring& wiring_;
  std::array<Doubt, kMaxJoints> doubts_{};
  // Actuators
  IndexSet known_ = 0;     ///< a reading was taken
  IndexSet believed_ = 0;  ///< its position was, at some time: from there on it has a place
  IndexSet doubtful_ = 0;
  IndexSet unsettled_ = 0;  ///< of them: never read, silent for a while, or not believed
  IndexSet held_ = 0;       ///< the reading was not taken
  IndexSet online_ = 0;     ///< in the last cycle
  LateAnswers late_answers_;
  IndexSet forgotten_ = 0;  ///< in the last cycle
  IndexSet referenced_ = 0;
  // Joints
  IndexSet answered_ = 0;
  IndexSet jumped_ = 0, displaced_joints_ = 0, lost_ = 0;
  IndexSet suspected_ = 0;  ///< as they came out of control
  std::array<Place, kMaxJoints> joints_{};
};

}  // namespace rmac
