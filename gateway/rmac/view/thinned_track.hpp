#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace rmac::cli {

/// Values over time of which only keys are kept: every value that was added lies within `within()` of the way between
/// the two keys about it. `Way` says what lies between two values, `between(a, b, share)`, and how far two are apart,
/// `apart(a, b)`.
template <typename Value, typename Way>
class ThinnedTrack {
 public:
  struct Key {
    double t_s = 0;
    Value value;
  };

  explicit ThinnedTrack(double tolerance, Way way = {})
      : way_(std::move(way)), tolerance_(tolerance), within_(tolerance) {}

  /// Times ascend.
  void add(double t_s, const Value& value) {
    if (keys_.empty()) {
      keys_.push_back({t_s, value});
      return;
    }
    const Key now{t_s, value};
    if (waiting_.size() >= kMostWaiting || !reaches(now)) {
      keys_.push_back(std::move(waiting_.back()));
      waiting_.clear();
    }
    waiting_.push_back(now);
  }

  /// The last value is a key too. Nothing is added behind it.
  void end() {
    if (!waiting_.empty()) keys_.push_back(std::move(waiting_.back()));
    waiting_.clear();
  }

  /// Leaves out keys that lie within twice as much.
  void coarsen() {
    tolerance_ *= 2;
    // Between two keys both ways are straight, so that they differ the most at a key.
    within_ += tolerance_;
    const std::vector<Key> keys = std::exchange(keys_, {});
    std::vector<Key> waiting = std::exchange(waiting_, {});
    for (const Key& key : keys) add(key.t_s, key.value);
    end();
    waiting_ = std::move(waiting);
  }

  [[nodiscard]] const std::vector<Key>& keys() const noexcept { return keys_; }
  [[nodiscard]] double within() const noexcept { return within_; }

 private:
  /// Each value is held against all that wait, so that this bounds what standing still costs.
  static constexpr std::size_t kMostWaiting = 64;

  [[nodiscard]] bool reaches(const Key& to) const {
    const Key& from = keys_.back();
    for (const Key& each : waiting_) {
      const double share = (each.t_s - from.t_s) / (to.t_s - from.t_s);
      if (way_.apart(way_.between(from.value, to.value, share), each.value) > tolerance_) return false;
    }
    return true;
  }

  Way way_;
  double tolerance_, within_;
  std::vector<Key> keys_, waiting_;
};

/// Of numbers.
struct NumberWay {
  [[nodiscard]] static double between(double a, double b, double share) noexcept { return a + (b - a) * share; }
  [[nodiscard]] static double apart(double a, double b) noexcept { return a < b ? b - a : a - b; }
};

}  // namespace rmac::cli
