#pragma once

#include <optional>

#include "rmac/fieldbus/simulated_plant.hpp"
#include "tree_machine.hpp"

namespace rmac::fault_test {

/// What a joint really does, as its plant says, cycle by cycle: the appliance sees nothing of it. mm or degrees, s.
class TrueJoint {
 public:
  TrueJoint() = default;
  TrueJoint(const JointDrive& drive, const fieldbus::AxisPlant& plant) : drive_(drive), plant_(&plant) {}

  /// One cycle: where the joint was to be, and how it was to speed up. `broken`: it is, from now on.
  void look(double position_set, double acceleration, bool broken);

  [[nodiscard]] double position() const { return plant_->load_rad() * drive_.mm_per_rad; }
  /// N or N·m that whatever it touches pushes it with.
  [[nodiscard]] double contact() const { return plant_->contact_nm() / drive_.nm_per_effort; }
  /// Of its motor, as a share of its largest effort.
  [[nodiscard]] double effort_share() const { return plant_->motor_nm() / drive_.nm_per_effort / drive_.max_effort; }
  /// Way that motor and brake need to stop it from here, its motor driving it on for the cycles until they do.
  [[nodiscard]] double way_to_stop() const;

  /// Cycles since its break, and since then with a way that was commanded, an effort above a quarter of the largest,
  /// a contact; 0: none yet.
  int since_break = 0, since_commanded = 0, since_effort = 0, since_contact = 0;
  double commanded = 0;             ///< way since `since_commanded`, or `since_contact`, began
  double most_contact = 0;          ///< N or N·m
  double met_stiffness_nm_rad = 0;  ///< of what it is to come upon
  double astray = 0;                ///< largest way that it went otherwise than it was to, since its break

  // Swings of its motor's torque, by more than a fifth of the largest, peak to peak.
  int since_swing = 0;  ///< cycles since the first of those that follow each other within 60 ms
  int turns = 0;        ///< of them, since they decay no more
  int chain = 0;        ///< of them all
  [[nodiscard]] bool still_swings() const;
  /// The path did so meanwhile, which turns the effort round as well.
  [[nodiscard]] bool path_speeds_up() const { return path_speeds_up_; }
  [[nodiscard]] double period_ms() const { return turns > 1 ? 2.0 * (last_turn_ - 1) / (turns - 1) : 0; }

 private:
  void look_at_contact();
  void look_at_swings();

  JointDrive drive_;
  const fieldbus::AxisPlant* plant_ = nullptr;
  double set_before_ = 0, set_at_break_ = 0, stood_at_break_ = 0;
  bool begun_ = false;
  /// Where a value turns round, having come back by `least`.
  struct Turns {
    double extreme = 0;
    bool rises = false;
    /// One cycle: the extreme, where it turned.
    std::optional<double> step(double now, double least);
  };
  Turns swings_;
  double turned_at_ = 0, first_swings_ = 0, last_swings_ = 0, swing_before_ = 0;
  int last_turn_ = 0, away_ = 0;
  bool path_speeds_up_ = false;
  double fastest_ = 0;
};

}  // namespace rmac::fault_test
