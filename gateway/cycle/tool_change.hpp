#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>

#include "gateway/cycle/standing_wishes.hpp"
#include "gateway/queue/cycle_news.hpp"
#include "gateway/queue/queue_step.hpp"
#include "gateway/state/event.hpp"
#include "gateway/tools/tool.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// Which tool is in the spindle, and the change under way: takes its steps, one after the other, at rest. One thread at
/// a time: the caller locks.
class ToolChange {
 public:
  enum class Outcome : std::uint8_t {
    Waits,    ///< for an input or a person: ask again
    Done,     ///< the step is
    Begun,    ///< done, and the spindles are stopping
    Mounted,  ///< done, and so is the change: the tool is in the spindle
    Failed,   ///< an input did not come in time: a fault
  };
  struct Seen {
    double t_s = 0;
    std::uint64_t inputs = 0;
    bool virtual_mode = false;  ///< no device is behind the inputs
  };

  ToolChange(StandingWishes& wishes, CycleNews& news) : wishes_(wishes), news_(news) {}

  /// What is in the spindle, as it is known when nothing is queued, and the torque that it bears.
  void set_mounted(std::optional<int> number, double max_torque_nm);
  [[nodiscard]] ToolsNow now(const std::deque<QueueStep>& queued) const;
  /// What the last change has put in the spindle.
  [[nodiscard]] const std::shared_ptr<const Tool>& last_mounted() const noexcept { return last_mounted_; }
  /// A change has begun, and is not done.
  [[nodiscard]] bool changing() const noexcept { return changing_; }
  /// A person was asked, and has not answered.
  [[nodiscard]] bool asked() const noexcept { return asked_; }

  /// Begins or goes on with a step that is no path.
  [[nodiscard]] Outcome take(QueueStep& step, const Seen& seen);
  /// The person who was asked says that this tool is in: then the step that asks is done. `queued` begins with that.
  [[nodiscard]] Expected<> confirm(int number, const std::deque<QueueStep>& queued, CycleState state);
  /// The queue was emptied, and a change was in it or not.
  void drop(bool was_queued);

 private:
  // Each begins or goes on with its step.
  Outcome take(const BeginToolChange& begin);
  Outcome take(const SwitchOutputs& outputs);
  Outcome take(AwaitInput& input, const Seen& seen);
  Outcome take(const AskPerson& person);
  Outcome take(const MountTool& mount);

  StandingWishes& wishes_;
  CycleNews& news_;
  std::optional<int> mounted_ = kNoTool;  ///< tool; none: not known
  std::shared_ptr<const Tool> last_mounted_;
  bool changing_ = false;
  bool asked_ = false;
};

}  // namespace rmac::gateway
