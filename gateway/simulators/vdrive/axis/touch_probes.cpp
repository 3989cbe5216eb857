#include "gateway/simulators/vdrive/axis/touch_probes.hpp"

#include <cmath>

namespace rmac::vdrive {

void TouchProbes::set_function(unsigned function) noexcept {
  probes_[0].set_function(function & 0xFFU);
  probes_[1].set_function(function >> 8 & 0xFFU);
}

void TouchProbes::see(const Shaft& shaft, double angle_before, const AxisSwitches& switches, double units) noexcept {
  const double now = shaft.angle();
  const auto in_units = [units](double position) { return static_cast<std::int32_t>(std::llround(position * units)); };
  const bool was_in = switches.touches(angle_before);
  const bool is_in = switches.touches(now);
  double edge = now;
  if (was_in != is_in) edge = was_in == (now > angle_before) ? switches.touches_to : switches.touches_from;
  probes_[0].see(contacts_[0] || is_in, in_units(shaft.position_at(edge)));
  probes_[1].see(contacts_[1], in_units(shaft.position()));
  const double turn = shaft.turn_of(now, switches.index);
  if (turn == shaft.turn_of(angle_before, switches.index)) return;
  const double pulse =
      switches.index + shaft.mechanics().encoder.counts_per_revolution * (now > angle_before ? turn : turn + 1);
  for (TouchProbe& probe : probes_) probe.see_index(in_units(shaft.position_at(pulse)));
}

}  // namespace rmac::vdrive
