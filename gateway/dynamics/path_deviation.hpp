#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

namespace rmac::gateway {

/// A time on end in which the tool was farther beside its path than is allowed; pauses of up to 16 cycles are none.
struct OffPath {
  int line = 0;  ///< of the program, when it began
  std::int64_t move_id = 0;
  double t_s = 0, until_s = 0;
  Eigen::Vector3d place{0, 0, 0};    ///< of the planned tip where it was the most, part frame
  double most_mm = 0, most_t_s = 0;  ///< and when
  double allowed_mm = 0;
};

/// How far a tool's tip is beside the path that was planned for it, whenever it gets there: that it comes late does not
/// count. A tip is held to what was planned for the 100 cycles before it and the 16 after it. One thread.
class PathDeviation {
 public:
  static constexpr std::size_t kMostOffPath = 1000;

  /// `allowed_mm`: 0: anything.
  explicit PathDeviation(double allowed_mm) : allowed_mm_(allowed_mm) {}

  struct Cycle {
    Eigen::Vector3d planned, truth;  ///< tips, in one frame
    Eigen::Vector3d place;           ///< the planned one, part frame
    double t_s = 0;
    int line = 0;
    std::int64_t move_id = 0;
  };
  /// Hears of each cycle, in turn, how far the tip is beside its path: up to 16 cycles later.
  void on_judged(std::function<void(double t_s, double off_mm)> told) { told_ = std::move(told); }
  void add(const Cycle& cycle);
  /// What comes next does not go on from what was before: another tool, or the end.
  void forget();

  [[nodiscard]] double allowed_mm() const noexcept { return allowed_mm_; }
  [[nodiscard]] double peak_mm() const noexcept { return peak_mm_; }
  [[nodiscard]] double rms_mm() const noexcept;
  /// In the order in which they began; at most `kMostOffPath`.
  [[nodiscard]] const std::vector<OffPath>& off_path() const noexcept { return off_path_; }

 private:
  static constexpr std::size_t kBefore = 100, kAfter = 16;  ///< cycles
  void judge(std::size_t at);

  double allowed_mm_;
  std::function<void(double, double)> told_;
  std::vector<Cycle> passed_;  ///< the newest last
  std::size_t judged_ = 0;     ///< of them
  double peak_mm_ = 0, sum_mm2_ = 0;
  std::size_t count_ = 0;
  std::vector<OffPath> off_path_;
};

}  // namespace rmac::gateway
