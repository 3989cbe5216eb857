#pragma once

#include "rmac/motion/drive_power.hpp"
#include "rmac/motion/servo_loop.hpp"
#include "servo/effort_filter.hpp"
#include "servo/force_loop.hpp"
#include "servo/position_correction.hpp"
#include "servo/probe_latch.hpp"
#include "servo/probe_signal.hpp"
#include "servo/spindle_loop.hpp"

namespace rmac {

/// State of a servo loop between cycles, and the steps of one. Arrays are indexed by joint or actuator.
struct ServoLoop::Impl {
  explicit Impl(ServoLoopParts loop_parts);

  void exchange(const ServoCommand& command, ServoReport& report) noexcept;
  void read_drive_inputs(std::uint64_t& now) const noexcept;
  void read_probe() noexcept;
  [[nodiscard]] ProbeReport probe_report() const noexcept;
  void watch_inputs(std::uint64_t now) noexcept;
  void watch_limits() noexcept;
  void begin_homing() noexcept;
  void begin_homing_turn() noexcept;
  void run_homing(const ServoCommand& command) noexcept;
  [[nodiscard]] bool homing_done(std::size_t actuator) noexcept;
  void command_homing(std::size_t actuator, DriveCommand& words) const noexcept;
  [[nodiscard]] Expected<> check_homing() const;
  /// A joint has a law exactly where its drives take a torque.
  [[nodiscard]] Expected<> check_modes() const;
  void read_actuators() noexcept;
  void read_joints() noexcept;
  void change_state(const ServoCommand& command) noexcept;
  void finish_reset() noexcept;
  void watch_drives() noexcept;
  void watch_drive(const DriveFeedback& words, bool in_use, ServoFault::Part part, std::size_t index) noexcept;
  void watch_enabling() noexcept;
  void watch_cycles(std::uint64_t missed) noexcept;
  void watch_joints() noexcept;
  void watch_jump(std::size_t joint) noexcept;
  void watch_velocity(std::size_t joint) noexcept;
  void watch_sensor(std::size_t joint) noexcept;
  void watch_contact(std::size_t joint) noexcept;
  void watch_torques() noexcept;
  void read_spindles() noexcept;
  void run_spindles(const ServoCommand& command) noexcept;
  void watch_spindles(const ServoCommand& command) noexcept;
  void make_live() noexcept;
  void make_setpoints(const ServoCommand& command, ServoReport& report) noexcept;
  void choose_setpoints(const ServoCommand& command, ServoReport& report) noexcept;
  void follow_force(std::size_t joint, double wanted) noexcept;
  void follow_velocity(std::size_t joint, const Setpoint& wanted) noexcept;
  void run_laws() noexcept;
  void engage_law(std::size_t joint, double from_effort) noexcept;
  void shafts_for(std::span<const double> joint_positions, std::span<double> shafts) const noexcept;
  void joints_for(std::span<const double> shafts, std::span<double> joint_positions) const noexcept;
  void reflect_setpoints() noexcept;
  void make_torques() noexcept;
  void aim_shafts() noexcept;
  void command_aim(std::size_t actuator, DriveCommand& words) const noexcept;
  void write_actuators() noexcept;
  void write_spindles() noexcept;
  void fill_drives(ServoReport& report) const noexcept;
  void fill(const ServoCommand& command, ServoReport& report) const noexcept;

  void raise(const ServoFault& fault) noexcept;
  void let_go() noexcept;
  void let_go(std::size_t joint) noexcept;
  /// The category that the configuration gives a fault, as far as there is a choice.
  [[nodiscard]] StopCategory stop_category(const ServoFault& found) const noexcept;
  /// Nothing but a spindle, or a joint of its own, hangs on the drive that this fault tells of.
  [[nodiscard]] bool can_do_without(const ServoFault& found) const noexcept;
  void begin_braking() noexcept;
  void brake() noexcept;
  void remove_power_at_rest() noexcept;
  /// After a fault: the stop is through.
  [[nodiscard]] bool stands() const noexcept;
  /// Joints are under control: to follow, or to brake and hold.
  [[nodiscard]] bool powered() const noexcept { return driving() || braking; }
  [[nodiscard]] bool driving() const noexcept {
    return state == ServoState::Enabling || state == ServoState::Engaged || state == ServoState::Homing;
  }
  [[nodiscard]] DriveWish wish(ServoFault::Part part, std::size_t index) const noexcept;
  /// The others brake without this drive, which is silent: should it come back, it is not enabled again.
  [[nodiscard]] bool given_up(ServoFault::Part part, std::size_t index) const noexcept;
  [[nodiscard]] bool owns(const ServoBus* bus, std::uint32_t axis) const noexcept;
  [[nodiscard]] bool operable(std::size_t joint) const noexcept;
  /// All joints that this actuator moves are live.
  [[nodiscard]] bool controlled(std::size_t actuator) const noexcept;
  [[nodiscard]] bool answering(std::size_t joint) const noexcept;
  [[nodiscard]] double resting_effort(std::size_t joint) const noexcept;
  [[nodiscard]] ServoInput input(std::size_t joint) const noexcept;
  /// Of the cycle in which the drives were where they say.
  [[nodiscard]] double following_error(std::size_t joint) const noexcept {
    return hold[joint] - gone_on[joint] - position[joint];
  }
  [[nodiscard]] const DriveFeedback& feedback(std::size_t actuator) const noexcept;
  [[nodiscard]] const DriveFeedback& spindle_feedback(std::size_t spindle) const noexcept;
  [[nodiscard]] double wanted_rpm(std::size_t spindle, const ServoCommand& command) const noexcept;
  [[nodiscard]] double shaft_rad(std::size_t actuator, double counts) const noexcept;
  [[nodiscard]] double shaft_counts(std::size_t actuator, double rad) const noexcept;
  void take_over_joints(std::uint32_t live_drives, const std::array<double, kMaxJoints>& shaft_set) noexcept;

  ServoLoopParts parts;
  std::size_t joints;  ///< of the kinematics
  std::size_t axes;    ///< held ones included
  std::size_t actuators;
  std::vector<std::shared_ptr<ServoBus>> buses;
  std::array<std::uint32_t, kMaxJoints> actuators_of{};  ///< bit i: this joint's effort reaches actuator i

  std::array<std::int8_t, kMaxJoints> sense{};      ///< of the shaft for its joint; 0 where several joints share it
  std::array<std::uint8_t, kMaxJoints> joint_of{};  ///< whose shaft it is, where `sense` is not 0
  std::vector<PositionCorrection> corrections;      ///< one a joint
  std::vector<EffortFilter> filters;                ///< one a joint
  std::vector<ForceLoop> force_loops;               ///< one a joint
  std::vector<SpindleLoop> spindles;

  ServoState state = ServoState::Off;
  ServoFault fault;
  bool fresh = true;          ///< no cycle has run, and no loop handed over
  bool power_spent = false;   ///< power must fall before it counts again
  bool reset_before = false;  ///< reset in the last cycle, for its edge
  bool resetting = false;
  std::int64_t waiting_cycles = 0;
  bool follows = false;
  std::uint64_t inputs = 0;  ///< in the last cycle
  ProbeSignal probe;
  std::vector<std::optional<ProbeLatch>> latches;  ///< one an actuator

  bool home_before = false;      ///< for its edge
  std::uint32_t homing = 0;      ///< bit i: drive of actuator i homes, or has in a turn before
  std::uint8_t homing_turn = 0;  ///< that is under way
  bool homing_ends = false;      ///< before it is through
  std::uint32_t homings = 0;
  std::array<int, kMaxJoints> homing_cycles{};  ///< in homing mode

  std::array<bool, kMaxJoints> seen{};  ///< a position of this drive was read
  std::array<std::int64_t, kMaxJoints> counts{};
  std::array<std::uint8_t, kMaxJoints> history{};  ///< positions before this one that a velocity may use, 2 at most
  std::array<double, kMaxJoints> shaft{}, shaft_before{}, shaft_velocity{};
  std::array<double, kMaxJoints> position{}, velocity{};
  std::array<double, kMaxJoints> shown1{}, shown2{};     ///< a joint's positions one and two cycles ago, uncorrected
  std::array<std::uint8_t, kMaxJoints> shown_history{};  ///< how many of the two there are
  std::array<double, kMaxJoints> jumped{};               ///< change of a joint's step from the last cycle to this one
  std::array<std::uint8_t, kMaxJoints> too_fast{};       ///< cycles on end beyond the bound of velocity
  std::array<std::uint8_t, kMaxJoints> too_strong{};     ///< the same of an actuator's torque
  std::array<double, kMaxJoints> force{};                ///< measured
  std::uint64_t missed_cycles = 0;                       ///< within the second that runs
  std::int64_t second_cycles = 0;                        ///< of that second
  std::array<double, kMaxJoints> hold{};
  std::array<double, kMaxJoints> set_velocity{}, set_acceleration{};
  std::array<double, kMaxJoints> slip{};      ///< of a joint under velocity control: `hold` less where the plan has it
  std::array<bool, kMaxJoints> on_the_way{};  ///< it followed the plan in the cycle before
  std::uint32_t late_drives = 0, late_joints = 0;  ///< bit i, j: it tells where it was a cycle before
  /// How far the setpoints of such joints went in this cycle.
  std::array<double, kMaxJoints> gone_on{}, velocity_gone_on{};
  std::array<double, kMaxJoints> effort{}, torque{};
  /// Where drives that follow setpoints themselves are sent, and were; `aimed`: they were in the cycle before.
  std::array<double, kMaxJoints> aim{}, aim_before{};
  std::array<bool, kMaxJoints> aimed{};
  std::uint32_t torque_drives = 0;        ///< bit i: actuator i takes a torque
  std::array<bool, kMaxJoints> live{};    ///< the joint's law is at work
  std::array<bool, kMaxJoints> handed{};  ///< live by handover: its law still has to be engaged

  /// A stop that keeps power: velocities of all joints fall to zero in step, so that the tool stays on its path as far
  /// as that is straight.
  bool braking = false;
  std::array<double, kMaxJoints> brake_from{};  ///< velocities at its beginning
  double brake_s = 0, braked_s = 0;             ///< time that it takes, and has taken

  /// A stop that removes power, drive by drive: actuators, then spindles.
  struct Rest {
    std::int64_t mark = 0;   ///< counts at which it seems to stand
    std::int64_t still = 0;  ///< cycles that it has been there
    bool reached = false;
  };
  std::array<Rest, kMaxJoints + kMaxSpindles> rest{};
  std::int64_t stopping_cycles = 0;
};

}  // namespace rmac
