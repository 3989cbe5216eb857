#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace rmac::cli {

template <typename Value>
struct TrackKey {
  double t_s = 0;
  Value value;
};

/// Any values that wait for the next key. `Way` says what lies between two, `between(a, b, share)`, and how far two are
/// apart, `apart(a, b)`.
template <typename Of, typename Way>
class WaitingValues {
 public:
  using Value = Of;
  using Key = TrackKey<Value>;

  explicit WaitingValues(Way way = {}) : way_(std::move(way)) {}

  /// Not where they are too many, for each is held against the way.
  [[nodiscard]] bool lie_on_the_way(const Key& from, const Key& to, double tolerance) const {
    if (waiting_.size() >= kMost) return false;
    return std::ranges::all_of(waiting_, [&](const Key& each) {
      const double share = (each.t_s - from.t_s) / (to.t_s - from.t_s);
      return way_.apart(way_.between(from.value, to.value, share), each.value) <= tolerance;
    });
  }
  void add(const Key& /*from*/, const Key& key, double /*tolerance*/) { waiting_.push_back(key); }
  void clear() noexcept { waiting_.clear(); }

 private:
  static constexpr std::size_t kMost = 64;  ///< bounds what standing still costs
  Way way_;
  std::vector<Key> waiting_;
};

/// Numbers that wait for the next key, however many: all that counts of them is how steep a way may be.
class WaitingNumbers {
 public:
  using Value = double;
  using Key = TrackKey<double>;

  [[nodiscard]] bool lie_on_the_way(const Key& from, const Key& to, double /*tolerance*/) const noexcept {
    const double slope = (to.value - from.value) / (to.t_s - from.t_s);
    return least_ <= slope && slope <= most_;
  }
  void add(const Key& from, const Key& key, double tolerance) noexcept {
    const double passed_s = key.t_s - from.t_s;
    least_ = std::max(least_, (key.value - tolerance - from.value) / passed_s);
    most_ = std::min(most_, (key.value + tolerance - from.value) / passed_s);
  }
  void clear() noexcept { *this = {}; }

 private:
  static constexpr double kAny = std::numeric_limits<double>::infinity();
  double least_ = -kAny, most_ = kAny;
};

/// Values over time of which only keys are kept: every value that was added lies within `within()` of the way between
/// the two keys about it. `Waiting` holds what came since the last key: `WaitingValues` or `WaitingNumbers`.
template <typename Waiting>
class ThinnedTrack {
 public:
  using Value = typename Waiting::Value;
  using Key = TrackKey<Value>;

  explicit ThinnedTrack(double tolerance, Waiting waiting = Waiting())
      : tolerance_(tolerance), within_(tolerance), waiting_(std::move(waiting)) {}

  /// Times ascend.
  void add(double t_s, const Value& value) {
    const Key now{t_s, value};
    if (keys_.empty()) {
      keys_.push_back(now);
      return;
    }
    if (!waiting_.lie_on_the_way(keys_.back(), now, tolerance_)) end();
    waiting_.add(keys_.back(), now, tolerance_);
    newest_ = now, waits_ = true;
  }

  /// The last value is a key too.
  void end() {
    if (std::exchange(waits_, false)) keys_.push_back(newest_);
    waiting_.clear();
  }

  /// Leaves out keys that lie within twice as much.
  void coarsen() {
    tolerance_ *= 2;
    // Between two keys both ways are straight, so that they differ the most at a key.
    within_ += tolerance_;
    end();
    for (const std::vector<Key> keys = std::exchange(keys_, {}); const Key& key : keys) add(key.t_s, key.value);
  }

  [[nodiscard]] const std::vector<Key>& keys() const noexcept { return keys_; }
  [[nodiscard]] double within() const noexcept { return within_; }

 private:
  double tolerance_, within_;
  std::vector<Key> keys_;
  Waiting waiting_;
  Key newest_{};
  bool waits_ = false;  ///< the newest is no key
};

}  // namespace rmac::cli
