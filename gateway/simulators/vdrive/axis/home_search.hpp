#pragma once

#include "gateway/simulators/vdrive/axis/axis_parameters.hpp"
#include "gateway/simulators/vdrive/axis/homing.hpp"
#include "gateway/simulators/vdrive/axis/shaft.hpp"

namespace rmac::vdrive {

/// The mode of homing: begins and ends the search by bit 4 of the controlword, and shows it the switches and pulses
/// that the shaft meets.
class HomeSearch {
 public:
  /// As after power on, or in another mode.
  void reset() noexcept;
  /// Power comes on: the pulse is awaited from here.
  void start_from(const Shaft& shaft, double index) noexcept { turn_ = shaft.turn_of(shaft.angle(), index); }

  /// One step. `standing` tells that the demand is at rest. Returns the velocity to move at, in counts/s.
  double step(const AxisParameters& parameters, const Shaft& shaft, bool standing) noexcept;
  /// True in the step in which home was found; the axis is still moving then.
  [[nodiscard]] bool found() const noexcept { return homing_.found(); }
  [[nodiscard]] Homing::State state() const noexcept { return homing_.state(); }

 private:
  Homing homing_;
  bool asked_before_ = false;  ///< bit 4
  double turn_ = 0;            ///< in which the index pulse was seen last
};

}  // namespace rmac::vdrive
