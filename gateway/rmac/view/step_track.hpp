#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

namespace rmac::cli {

/// Which of some numbers holds, from when on; looked at less often where it changes too many times.
class StepTrack {
 public:
  explicit StepTrack(std::size_t most) : most_(most) {}

  /// Times ascend.
  void add(double t_s, int value) {
    if (!t_s_.empty() && (value == values_.back() || t_s < t_s_.back() + apart_s_)) return;
    t_s_.push_back(t_s);
    values_.push_back(value);
    while (t_s_.size() > most_) thin();
  }

  [[nodiscard]] const std::vector<double>& t_s() const noexcept { return t_s_; }
  [[nodiscard]] const std::vector<int>& values() const noexcept { return values_; }
  /// Two changes are no nearer to each other, and each is told by less than twice as much later, if it holds for that
  /// long; 0: every one is there that was looked at.
  [[nodiscard]] double apart_s() const noexcept { return apart_s_; }

 private:
  static constexpr double kFirstApart_s = 1.0 / 30;

  void thin() {
    apart_s_ = apart_s_ == 0 ? kFirstApart_s : 2 * apart_s_;
    std::size_t kept = 1;
    for (std::size_t i = 1; i < t_s_.size(); ++i) {
      // Later where it holds for longer: what lasts is never left out.
      const double at_s = std::max(t_s_[i], t_s_[kept - 1] + apart_s_);
      if (i + 1 < t_s_.size() && t_s_[i + 1] <= at_s) continue;
      t_s_[kept] = at_s;
      values_[kept] = values_[i];
      ++kept;
    }
    t_s_.resize(kept);
    values_.resize(kept);
  }

  std::size_t most_;
  double apart_s_ = 0;
  std::vector<double> t_s_;
  std::vector<int> values_;
};

/// Which of some texts holds, from when on.
class NamedSteps {
 public:
  explicit NamedSteps(std::size_t most) : steps_(most) {}

  void add(double t_s, const std::string& name) {
    const auto known = std::ranges::find(names_, name);
    steps_.add(t_s, static_cast<int>(known - names_.begin()));
    if (known == names_.end()) names_.push_back(name);
  }

  /// By their place in `names()`.
  [[nodiscard]] const StepTrack& steps() const noexcept { return steps_; }
  /// In the order in which they came.
  [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }

 private:
  StepTrack steps_;
  std::vector<std::string> names_;
};

}  // namespace rmac::cli
