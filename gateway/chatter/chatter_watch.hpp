#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "gateway/chatter/cut_in_time.hpp"
#include "gateway/chatter/cut_stability.hpp"

namespace rmac::gateway {

/// A time on end in which a cut chatters; looks at one move go on from each other.
struct Chatter {
  int line = 0;  ///< of the program, when it began
  std::int64_t move_id = 0;
  double t_s = 0, until_s = 0;
  // Where it is the worst:
  double most_t_s = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< of the tool's tip, part frame
  double share = 0;                ///< of its depth at which it would begin to
  double frequency_hz = 0;
  double rpm = 0;                      ///< that the spindle turns with
  std::optional<double> steady_rpm{};  ///< the nearest to it at which this cut is steady
};

/// Notes where cuts chatter: by the mean over a turn of what chips change, and in time where that is far from all there
/// is and the cut not far from its limit. One thread.
class ChatterWatch {
 public:
  static constexpr std::size_t kMost = 1000;

  /// A cut, as it was found at one place of the way.
  struct Look {
    // Its `ChipStiffness`, in the frame of the modes:
    Eigen::Matrix3d cutting_n_mm;
    std::vector<Eigen::Matrix3d> over_pitch_n_mm;
    int teeth = 0;
    double rpm = 0, most_rpm = 0;  ///< most: that spindle and tool can; 0: not known
    double t_s = 0;
    int line = 0;
    std::int64_t move_id = 0;
    Eigen::Vector3d place;  ///< part frame
  };
  void add(const Look& look, std::span<const VibrationMode> modes);

  /// In the order in which they began; at most `kMost`.
  [[nodiscard]] const std::vector<Chatter>& found() const noexcept { return found_; }
  /// The least share of its depth at which any cut would have begun to; infinity: nothing was cut, or nothing gives
  /// way.
  [[nodiscard]] double least_share() const noexcept { return least_; }

 private:
  /// By how much a limit in time differed from that by the mean, and of which cut.
  struct InTime {
    double by_mean = 0, unevenness = 0, rpm = 0;
    double ratio = 1;
  };
  [[nodiscard]] double ratio_in_time(const Look& look, double unevenness, double by_mean, const CutInTime& cut);

  std::vector<Chatter> found_;
  InTime in_time_;
  double proposed_at_ = 0;  ///< share of the last finding for which a speed was looked for
  double least_ = std::numeric_limits<double>::infinity();
};

}  // namespace rmac::gateway
