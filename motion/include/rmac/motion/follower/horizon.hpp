#pragma once

#include <atomic>
#include <cstdint>

namespace rmac {

/// Motion is planned so far ahead while there is something to plan, s.
inline constexpr double kPromisedHorizon_s = 0.05;

/// Why motion is not planned further ahead.
enum class HorizonLimit : std::uint8_t {
  Stop,      ///< motion was told to end, or was not told to begin
  Enough,    ///< more is queued, and what is planned lasts for `kPromisedHorizon_s`
  Planning,  ///< more is queued, and it does not: the planner is behind
  Queue,     ///< all that is queued is planned
  HeldBack,  ///< all but the last lines, which wait for what follows to be joined to it
  Rest,      ///< what follows begins at rest, and is not planned before: the next single move, what needs no motion
  Override,  ///< it is 0, or motion is being planned anew for another one
};

[[nodiscard]] const char* to_string(HorizonLimit limit) noexcept;

/// How far ahead motion is planned, in a cycle.
struct Horizon {
  double s = 0;  ///< until the machine rests, if nothing more is planned
  HorizonLimit limit = HorizonLimit::Stop;
};

/// What the planner knows of the limit of a plan, after it published it. The planner writes, the servo thread reads;
/// neither waits.
class HorizonNews {
 public:
  /// `plan`: its id; 0: there is none.
  void tell(std::uint64_t plan, HorizonLimit limit) noexcept {
    word_.store(plan << kBits | static_cast<std::uint64_t>(limit), std::memory_order_release);
  }
  /// What was told last, if it was about this plan; else `otherwise`.
  [[nodiscard]] HorizonLimit of(std::uint64_t plan, HorizonLimit otherwise) const noexcept {
    const std::uint64_t word = word_.load(std::memory_order_acquire);
    return word >> kBits == plan ? static_cast<HorizonLimit>(word & kMask) : otherwise;
  }

 private:
  static constexpr unsigned kBits = 8;
  static constexpr std::uint64_t kMask = (1U << kBits) - 1;
  std::atomic<std::uint64_t> word_{0};
};

/// Whose fault a short horizon is, cycle by cycle. What comes late is planned late: the planner is behind only where it
/// let a horizon become short that was long enough, or has had `kPromisedHorizon_s` to make it longer. Until then what
/// ended it before is to blame. Servo thread.
class HorizonWatch {
 public:
  explicit HorizonWatch(double period_s) noexcept : period_s_(period_s) {}

  /// In this cycle so much is planned, and that is why it is not more; `Planning` where there is more to plan.
  void step(std::int64_t cycle, const Horizon& planned) noexcept;
  [[nodiscard]] const Horizon& now() const noexcept { return now_; }

 private:
  double period_s_;
  std::int64_t limited_cycle_ = 0;  ///< the last one in which there was nothing more to plan
  Horizon now_;
};

}  // namespace rmac
