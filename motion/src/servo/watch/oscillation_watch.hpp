#pragma once

#include <array>
#include <cstdint>

#include "rmac/motion/ports/digital_control_interface.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "servo/faults/fault_sink.hpp"
#include "servo/watch/turn_counter.hpp"

namespace rmac {

/// What it looks at in one cycle: N and mm, or N·m and degrees.
struct OscillationSeen {
  double effort = 0;             ///< measured in this cycle, or commanded in the one before
  bool effort_measured = false;  ///< by drives, with the position
  int answer_delay = 0;          ///< the position is that of so many cycles before
  double position = 0;           ///< measured
  double acceleration_set = 0;
};

/// Finds a joint whose loop swings: its effort turns round again and again, by much, without becoming less, and not
/// because the path does; and it is the loop that drives it. A force from outside, such as of teeth that cut, makes an
/// effort turn round as well, but then the effort takes energy out of the motion instead of putting it in. Found within
/// three periods or 50 ms, whichever is later. Real-time safe.
class OscillationWatch {
 public:
  /// `joint` must outlive it; `index` names it in faults.
  OscillationWatch(const ServoJoint& joint, std::size_t index, double period_s) noexcept
      : joint_(&joint), index_(static_cast<std::uint32_t>(index)), period_s_(period_s) {}

  void step(const OscillationSeen& seen, FaultSink& faults) noexcept;
  /// The effort that acted while the joint went its last way.
  [[nodiscard]] double acted() const noexcept { return acted_; }
  /// Two periods of it were seen, which the path does not explain.
  [[nodiscard]] bool swings() const noexcept { return turned_ >= kTurns - 2 + 2 * path_turned_; }
  /// The effort turned round some times more than the path explains.
  [[nodiscard]] bool trembles() const noexcept { return chain_ >= 3 + 2 * path_chain_; }
  /// And by half of all that it may be, peak to peak.
  [[nodiscard]] bool shakes() const noexcept { return trembles() && turns_.swing() > joint_->max_effort / 2; }
  void raise(FaultSink& faults) const noexcept;
  /// The joint is not under control.
  void rest() noexcept;

 private:
  static constexpr int kTurns = 7;     ///< three periods
  static constexpr int kCompared = 2;  ///< swings, the latest with the first

  double take_effort(const OscillationSeen& seen) noexcept;
  void begin() noexcept;
  void add_turn() noexcept;
  [[nodiscard]] double hz() const noexcept;
  [[nodiscard]] double latest_swings() const noexcept;
  [[nodiscard]] bool lasts() const noexcept;

  const ServoJoint* joint_;
  std::uint32_t index_;
  double period_s_;

  TurnCounter turns_;
  TurnCounter path_turns_;                              ///< of the wanted acceleration
  std::array<double, kMostAnswerDelay + 2> efforts_{};  ///< of the last cycles, the latest first
  double acted_ = 0, last_way_ = 0, last_position_ = 0;
  bool begun_ = false;  ///< there was a cycle before

  // Since the first turn.
  int turned_ = 0;
  int chain_ = 0;       ///< turns on end, of which those that became smaller were forgotten
  int path_chain_ = 0;  ///< of the path, meanwhile
  int path_turned_ = 0;
  double most_acceleration_ = 0;
  std::int64_t cycles_ = 0;
  struct {
    std::int64_t at = 0;
    std::int64_t gap = 0;  ///< cycles since the one before
  } last_turn_;
  struct {
    std::array<double, kCompared> latest{};
    double first = 0;  ///< the sum of so many
  } swings_;
  struct {
    double work = 0;               ///< of the efforts' changes on the ways' changes, the latest for the most part
    double efforts = 0, ways = 0;  ///< sums of the squares of both
  } changes_;
};

}  // namespace rmac
