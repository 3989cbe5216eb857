#pragma once

#include <array>
#include <cstddef>

#include "servo/watch/response_seen.hpp"

namespace rmac {

/// What became of a joint lately, two dozen samples of it: why it left its bound of following error.
/// Real-time safe.
class ErrorHistory {
 public:
  ErrorHistory(double period_s, double sample_s) noexcept;

  void step(const ResponseSeen& seen) noexcept;
  void restart() noexcept { kept_ = 0; }

  enum class Cause { Unknown, StandsStill, WrongDirection };
  /// `bound`: of the following error.
  [[nodiscard]] Cause cause(double bound) const noexcept;
  /// Of what `cause` looked at: the way that the joint was to go, and went, and the time.
  [[nodiscard]] double wanted(double bound) const noexcept;
  [[nodiscard]] double gone() const noexcept;
  [[nodiscard]] double duration_s(double bound) const noexcept;
  [[nodiscard]] double effort() const noexcept { return kept_ < 1 ? 0 : ago(0).effort; }

 private:
  static constexpr std::size_t kMost = 24;
  struct Sample {
    double position, position_set, effort;
  };
  /// So many samples ago; 0 is the latest.
  [[nodiscard]] const Sample& ago(std::size_t samples) const noexcept {
    return samples_[(next_ + kMost - 1 - samples) % kMost];
  }
  /// Samples ago since when the joint was to go about its bound.
  [[nodiscard]] std::size_t wanted_since(double bound) const noexcept;
  [[nodiscard]] bool runs_away() const noexcept;
  [[nodiscard]] bool pushes(std::size_t since, double error) const noexcept;
  [[nodiscard]] bool is_no_step(std::size_t since, double bound) const noexcept;

  int cycles_a_sample_;
  double period_s_;
  std::array<Sample, kMost> samples_{};
  std::size_t next_ = 0, kept_ = 0;
  int cycle_ = 0;
};

}  // namespace rmac
