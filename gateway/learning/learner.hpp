#pragma once

#include <memory>
#include <string>
#include <vector>

#include "gateway/learning/pass.hpp"
#include "rmac/motion/servo/learned_path.hpp"

namespace rmac::gateway {

/// Iterative learning control (D. A. Bristow, M. Tharayil, A. G. Alleyne, "A survey of iterative learning control",
/// IEEE Control Systems Magazine 26 (2006), 3, 96): the offsets of the next pass are Q(c + γ e(t + lead)), c those of
/// this one, e its following error, Q a low-pass without a shift of phase. It converges, and each pass is better than
/// the one before, where |Q (1 − γ z^lead T)| < 1 at all frequencies, T being the closed loop (equation 17). So Q ends
/// about where the loop does. A joint that comes out worse all the same goes back to its best offsets, and from
/// then on adds to them half as fast and up to half the frequency.
class Learner {
 public:
  struct Options {
    double period_s = 0.001;
    double bandwidth_hz = 20;       ///< of Q
    double gain = 0.7;              ///< γ
    double lead_s = 0.004;          ///< delay of the closed loop
    std::vector<double> largest{};  ///< offset of each joint, mm or degrees; 0: learns nothing
  };
  explicit Learner(Options options);

  /// Takes a pass that was run with `next`'s offsets. Its steps give the places.
  void learn(const Pass& pass);
  /// For the next pass; nullptr: none yet.
  [[nodiscard]] const std::shared_ptr<const LearnedPath>& next() const noexcept { return next_; }
  /// Why there are none after a pass.
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }
  [[nodiscard]] const LearnedPath::Parts& next_parts() const noexcept { return parts_; }
  /// From now on `next` are the offsets of each joint's best pass.
  void settle(const Pass& last);
  /// The joint went back to its best offsets at least once.
  [[nodiscard]] bool fell_back(std::size_t joint) const noexcept { return joints_[joint].fell_back; }
  /// Pass, from 0, whose offsets are the joint's best, and its error.
  [[nodiscard]] std::size_t best_pass(std::size_t joint) const noexcept { return joints_[joint].best_pass; }
  [[nodiscard]] double best_rms(std::size_t joint) const noexcept { return joints_[joint].best_rms; }

 private:
  struct Joint {
    double bandwidth_hz = 0, gain = 0;
    double best_rms = 0;
    std::size_t best_pass = 0;
    std::shared_ptr<const LearnedPath> best{};  ///< nullptr: without offsets
    bool fell_back = false;
  };
  [[nodiscard]] std::vector<double> offsets_of(const LearnedPath* path, const Pass& pass, std::size_t joint) const;
  [[nodiscard]] std::vector<double> improved(const Pass& pass, std::size_t joint) const;
  void lay(const Pass& pass, const std::vector<std::vector<double>>& offsets);

  Options options_;
  std::vector<Joint> joints_;
  std::size_t passes_ = 0;
  std::shared_ptr<const LearnedPath> next_;
  LearnedPath::Parts parts_;
  std::string problem_;
};

}  // namespace rmac::gateway
