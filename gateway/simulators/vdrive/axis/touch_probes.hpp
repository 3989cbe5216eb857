#pragma once

#include <array>

#include "gateway/simulators/vdrive/axis/axis_parameters.hpp"
#include "gateway/simulators/vdrive/axis/shaft.hpp"
#include "gateway/simulators/vdrive/axis/touch_probe.hpp"

namespace rmac::vdrive {

/// The two touch probes of a drive and the contacts at their inputs (CiA 402-2, 60B8h to 60BDh). The first one's closes
/// where the shaft is in its zone, at the very count, too.
class TouchProbes {
 public:
  /// As after power on; contacts stay as they are.
  void reset() noexcept { probes_ = {}; }
  /// 60B8h
  void set_function(unsigned function) noexcept;
  /// Somebody closes the contact of a probe, 0 or 1, or opens it.
  void touch(std::size_t probe, bool closed) noexcept { contacts_.at(probe) = closed; }
  /// The shaft has come from `angle_before` to where it is. `units` are those of positions, a count.
  void see(const Shaft& shaft, double angle_before, const AxisSwitches& switches, double units) noexcept;

  /// 60B9h
  [[nodiscard]] unsigned status() const noexcept { return probes_[0].status() | probes_[1].status() << 8; }
  [[nodiscard]] const TouchProbe& probe(std::size_t number) const noexcept { return probes_.at(number); }

 private:
  std::array<TouchProbe, 2> probes_;
  std::array<bool, 2> contacts_{};
};

}  // namespace rmac::vdrive
