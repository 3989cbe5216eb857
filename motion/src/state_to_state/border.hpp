#pragma once

#include <optional>

#include "state_to_state/transfer.hpp"

namespace rmac {

/// The largest distance that a transfer can cover, as a function of its duration: one border of what is reachable (eq.
/// 7 to 12). The smallest is the mirrored transfer's.
class Border {
 public:
  /// Which durations: those before the gap, or those behind it (all, where there is none).
  enum class Part { BeforeGap, Behind };
  Border(const Transfer& transfer, const Durations& durations, Part part) noexcept;

  /// One motion of the border.
  struct Place {
    enum class Kind { Early, Plateau, Cruise } kind;
    double value;  ///< Early: the peak acceleration; Plateau: the peak's acceleration if unbounded; Cruise: its time
  };

  /// The place of the part's shortest duration.
  [[nodiscard]] Place begin() const noexcept;
  [[nodiscard]] Place at_duration(double duration) const noexcept;
  [[nodiscard]] double distance(const Place& place) const noexcept;
  [[nodiscard]] double duration(const Place& place) const noexcept;
  [[nodiscard]] Phases phases(const Place& place) const noexcept;

  /// The first place from `from` on that reaches `distance`, which the border at `from` does not.
  [[nodiscard]] std::optional<Place> first_reaching(double distance, const Place& from) const noexcept;

 private:
  struct Early {
    double trough, dwell, duration, distance;
    double rate;   ///< of the distance by the duration (eq. 9)
    double slope;  ///< of the distance by the peak
  };
  [[nodiscard]] Early early(double peak) const noexcept;
  struct Plateau {
    double duration, distance, slope;
  };
  [[nodiscard]] Plateau plateau(double w) const noexcept;
  [[nodiscard]] std::optional<Place> first_early(double distance, double from) const noexcept;
  [[nodiscard]] double slowest_peak() const noexcept;
  [[nodiscard]] double plateau_peak(double t) const noexcept;

  Transfer x_;  ///< reversed where its end has the higher settled velocity
  bool reversed_ = false;
  bool has_early_ = false;
  bool has_plateau_ = true;
  double early_end_ = 0;  ///< the last peak acceleration of Early
  double early_end_duration_ = 0;
  double k_ = 0;                  ///< trough² = peak² + k
  double v_from_ = 0, v_to_ = 0;  ///< where the rise of a begins and its second rise ends, at a = 0
  double offset_ = 0;             ///< distance of what these extensions add
  double w_begin_ = 0, w_end_ = 0;
};

}  // namespace rmac
