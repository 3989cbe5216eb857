#pragma once

#include <cstdint>

#include "rmac/motion/drive_scale.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac {

/// Where the shaft of one motor is, and how fast it turns, from the words of its drive. Real-time safe.
class ShaftReader {
 public:
  ShaftReader(const DriveScale& scale, double period_s) noexcept : scale_(scale), period_s_(period_s) {}

  /// The words of this cycle. Where an answer is missing, the shaft goes on at its speed for three cycles, and then is
  /// taken to stand where it got to; while the drive does not answer at all, where it was.
  void read(const DriveFeedback& words) noexcept;
  /// What was read in this cycle is not believed: the shaft stands where it was.
  void refuse() noexcept;
  /// The shaft is where these words say, however far that is; its velocity begins anew.
  void put_at(const DriveFeedback& words) noexcept;
  /// The shaft's angle where the drive's word reads so, by the nearer way from here.
  [[nodiscard]] double rad_at(std::int32_t position_counts) const noexcept;
  /// The counter is about to jump, and none of that is motion.
  void forget() noexcept;
  /// As another loop left it; `seen`: its counts hold a reading.
  void take_over(std::int64_t counts, bool seen) noexcept;

  [[nodiscard]] double rad() const noexcept { return rad_; }
  [[nodiscard]] double rad_s() const noexcept { return rad_s_; }
  [[nodiscard]] std::int64_t counts() const noexcept { return counts_; }  ///< unwrapped
  [[nodiscard]] bool seen() const noexcept { return seen_; }              ///< a position was read

 private:
  [[nodiscard]] bool goes_on(const DriveFeedback& words) noexcept;
  void come_back(double now) noexcept;

  DriveScale scale_;
  double period_s_;
  bool seen_ = false;
  std::int64_t counts_ = 0;
  std::uint8_t gone_on_ = 0;  ///< cycles without an answer
  std::uint8_t history_ = 0;  ///< readings before the next one that its velocity may use, 2 at most
  double rad_ = 0, rad_before_ = 0, rad_s_ = 0;
  std::int64_t counts_before_ = 0;  ///< the last reading, for `refuse`
};

}  // namespace rmac
