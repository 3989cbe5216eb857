#pragma once

#include <algorithm>

namespace rmac {

/// Tells where a value turns round, and by how much it swung since it did so before. What swings by less is none.
/// Real-time safe.
class TurnCounter {
 public:
  /// One cycle. True when `value` has come back from an extreme by more than `least`: that was a turn.
  [[nodiscard]] bool step(double value, double least) noexcept {
    if (!begun_) {
      begun_ = true;
      last_turn_ = extreme_ = value;
      return false;
    }
    const bool further = rises_ ? value >= extreme_ : value <= extreme_;
    if (further) extreme_ = value;
    if (further || (rises_ ? extreme_ - value : value - extreme_) <= least) return false;
    swing_ = rises_ ? extreme_ - last_turn_ : last_turn_ - extreme_;
    last_turn_ = extreme_;
    extreme_ = value;
    rises_ = !rises_;
    return true;
  }
  /// Between the last two turns; peak to peak.
  [[nodiscard]] double swing() const noexcept { return std::max(swing_, 0.0); }
  void restart() noexcept { *this = {}; }

 private:
  bool begun_ = false;
  bool rises_ = false;
  double extreme_ = 0;    ///< since the last turn
  double last_turn_ = 0;  ///< the extreme before
  double swing_ = 0;
};

}  // namespace rmac
