#pragma once

#include <cstdint>

namespace rmac {

struct ServoProgress;

/// How long planning takes, in servo cycles: a plan must begin so far ahead of the servo loop to be there in time.
/// Learns from the cycles that go by while a plan is made, and from plans that came too late.
class PlanningTime {
 public:
  /// A plan is begun in this cycle; one in haste is to be there after `kShortestLead` cycles, whatever is known.
  void begin(std::int64_t cycle, bool in_haste = false) noexcept {
    began_ = cycle;
    in_haste_ = in_haste;
  }
  /// No plan comes of what was begun, and its time tells nothing of a plan's.
  void withdraw() noexcept { began_ = -1; }
  /// Takes up what the servo loop tells afterwards. A refused plan came too late: the next one is left more time,
  /// unless it was tried in haste.
  void learn(const ServoProgress& progress) noexcept;
  /// Cycles from now after which a plan begun now will have reached the servo loop.
  [[nodiscard]] std::int64_t lead() const noexcept;
  static constexpr std::int64_t kShortestLead = 2;

 private:
  double cycles_ = 0;               ///< that went by while a plan was made, lately
  std::int64_t began_ = -1;         ///< cycle in which the last plan was begun; -1 once its time is known
  bool in_haste_ = false;           ///< the last plan was
  std::uint64_t last_refused_ = 0;  ///< the last plan that came too late
};

}  // namespace rmac
