#pragma once

#include <random>
#include <string>

#include "faulty_bus.hpp"
#include "joint_path.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "tree_machine.hpp"
#include "true_joint.hpp"

namespace rmac::fault_test {

/// What goes wrong with one joint, on purpose.
enum class Broken : std::uint8_t {
  Nothing,        ///< only what a machine has to bear
  FrozenEncoder,  ///< its reading stays where it is
  ReversedSign,   ///< of motor or encoder, from the start
  Oscillation,    ///< gains that were made for a joint several times as heavy
  BlockedAxis,    ///< its guide seizes where it is
  Contact,        ///< it meets something hard on its way
  LostAnswers,    ///< its drive falls silent
  Count
};
inline constexpr auto kBrokenCount = static_cast<unsigned>(Broken::Count);
[[nodiscard]] const char* to_string(Broken broken);

/// What it does when that happens.
enum class Doing : std::uint8_t { Rests, Creeps, Feeds, Jogs, Reverses, WasJustEnabled, Brakes, Count };
[[nodiscard]] const char* to_string(Doing doing);

/// What one fault led to, as the plant says.
struct Outcome {
  bool happened = false;     ///< it became a fault: gains that hold all the same are none
  bool right_cause = false;  ///< the one of the joint that is named, and no other; or none where nothing happened
  bool in_time = true;       ///< within its bound
  bool held = true;          ///< the joint went no further from there than its motor and brake need
  int noticed_after_ms = 0;
  double commanded = 0;     ///< mm or degrees that it was to go from the beginning of the fault until it was noticed
  double gone = 0;          ///< what its load went astray until then
  double gone_further = 0;  ///< and from there
  ServoFault fault{};
  std::string told;  ///< what was done, and what came of it
};

/// A joint of a machine of the tree, at its work, on axes that bend, stick and cog, half to twice as heavy as they are
/// said to be, with what a machine has to bear beside; and then it breaks. All of it follows from the seed.
class SeededFault {
 public:
  SeededFault(const TreeMachine& machine, Broken broken, unsigned seed);
  [[nodiscard]] Outcome run();

 private:
  // What is drawn.
  void draw_plant();
  void give_resonance(fieldbus::AxisPlantParameters& plant, ServoJoint& joint);
  void draw_path();
  void draw_events();
  void build();

  // What is done.
  void cycle();
  void plan();
  void disturb();
  void disturb_words();
  void break_it();
  void judge_stop(Outcome& outcome);
  void judge(Outcome& outcome);
  [[nodiscard]] bool overdue() const;
  [[nodiscard]] bool named_rightly() const;

  double uniform(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  double log_uniform(double from, double to) { return from * std::pow(to / from, uniform(0, 1)); }
  bool chance(double share) { return uniform(0, 1) < share; }

  const TreeMachine& machine_;
  Broken broken_;
  unsigned seed_;
  std::mt19937 random_;
  std::size_t joint_ = 0;
  Doing doing_ = Doing::Rests;
  JointDrive drive_;
  std::vector<fieldbus::SimulatedAxis> axes_;
  ServoLoopParts parts_;
  std::vector<std::vector<double>> gains_;
  double mass_factor_ = 1;
  bool tells_torque_ = true;
  std::array<JointPath, 2> paths_;
  int break_at_ = 0;  ///< cycles after the joints follow
  double gain_factor_ = 1;

  // What it has to bear beside: cycles after the joints follow, or shares.
  int pushed_at_ = -1;
  double push_nm_ = 0, push_rise_s_ = 0.001, teeth_nm_ = 0, teeth_hz_ = 0, miss_share_ = 0, repeat_share_ = 0,
         late_share_ = 0;

  std::shared_ptr<fieldbus::SimulatedInterface> simulated_;
  std::shared_ptr<FaultyBus> bus_;
  std::unique_ptr<ServoLoop> loop_;
  TrueJoint truth_;
  ServoCommand command_;
  ServoReport report_;
  std::array<double, kMaxJoints> start_{};
  static constexpr int kLoadedBefore = 100;  ///< cycles in which the machine is loaded before it is enabled
  int all_cycles_ = 0;
  int cycles_ = 0;       ///< since the joints follow
  int rests_until_ = 0;  ///< no answer is missed, repeated or late before
  bool is_broken_ = false;
};

}  // namespace rmac::fault_test
