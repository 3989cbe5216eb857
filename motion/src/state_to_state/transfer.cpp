#include "state_to_state/transfer.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// Whether the velocity gained by going straight from a0 to a1 is too small (eq. 4).
bool rises_first(const Transfer& x) noexcept {
  return x.v1 - x.v0 >= 0.5 * (x.a0 + x.a1) * std::abs(x.a1 - x.a0);
}

struct Change {
  double peak, dwell;
};

/// Up to the peak acceleration, dwell there, down (eq. 5).
Change rise_and_fall(const Transfer& x) noexcept {
  const double squares = 0.5 * (x.a0 * x.a0 + x.a1 * x.a1);
  const double peak = root(x.v1 - x.v0 + squares);
  if (peak <= x.a_top) return {std::max({peak, x.a0, x.a1}), 0};
  return {x.a_top, std::max((x.v1 - x.v0 + squares - x.a_top * x.a_top) / x.a_top, 0.0)};
}

/// Down from a settled velocity above the top until it is at the top (section 2).
Phases bring_down(double& v, double& a, double settled, double v_top, double a_bottom) noexcept {
  Phases phases;
  if (a < -a_bottom) {
    phases.add(-a_bottom - a, 1);
    v += 0.5 * (a_bottom * a_bottom - a * a);
    a = -a_bottom;
  } else {
    const double level = v + 0.5 * a * a;  // the velocity where the falling acceleration passes zero
    const double deepest = std::min(std::sqrt(level - v_top), a_bottom);
    phases.add(a + deepest, -1);
    v = level - 0.5 * deepest * deepest;
    a = -deepest;
    settled = level - deepest * deepest;
  }
  if (a == -a_bottom && settled > v_top) {
    phases.add((settled - v_top) / a_bottom, 0);
    v -= settled - v_top;
  }
  return phases;
}

}  // namespace

void Phases::mirror() noexcept {
  for (std::size_t i = 0; i < count; ++i) phase[i].jerk = -phase[i].jerk;
}

void Phases::reverse() noexcept {
  std::reverse(phase.begin(), phase.begin() + static_cast<std::ptrdiff_t>(count));
}

Phases bring_inside(double& v, double& a, const Transfer& bounds) noexcept {
  const double settled = settled_velocity(v, a);
  if (settled > bounds.v_top) return bring_down(v, a, settled, bounds.v_top, bounds.a_bottom);
  if (settled < -bounds.v_bottom) {
    v = -v, a = -a;
    Phases phases = bring_down(v, a, -settled, bounds.v_bottom, bounds.a_top);
    v = -v, a = -a;
    phases.mirror();
    return phases;
  }
  Phases phases;
  const double nearest = std::clamp(a, -bounds.a_bottom, bounds.a_top);
  if (a != nearest) {
    const double duration = std::abs(a - nearest);
    v += 0.5 * (a + nearest) * duration;
    phases.add(duration, a > nearest ? -1 : 1);
    a = nearest;
  }
  return phases;
}

Phases fastest_change(const Transfer& transfer) noexcept {
  const bool up = rises_first(transfer);
  const Transfer x = up ? transfer : transfer.mirrored();
  const Change change = rise_and_fall(x);
  Phases phases;
  phases.add(change.peak - x.a0, 1);
  phases.add(change.dwell, 0);
  phases.add(change.peak - x.a1, -1);
  if (!up) phases.mirror();
  return phases;
}

Durations::Durations(const Transfer& transfer) noexcept {
  const bool up = rises_first(transfer);
  const Transfer x = up ? transfer : transfer.mirrored();
  const Change change = rise_and_fall(x);
  shortest = 2 * change.peak + change.dwell - x.a0 - x.a1;
  gap_begin = gap_end = shortest;
  // Only where both accelerations help in the direction of the change can waiting lead past it.
  const double gain = x.v1 - x.v0, squares = 0.5 * (x.a0 * x.a0 + x.a1 * x.a1);
  if (!(x.a0 > 0 && x.a1 > 0 && gain < squares)) return;
  const double trough = std::sqrt(squares - gain);
  gap_begin = std::max(x.a0 + x.a1 - 2 * trough, shortest);
  const double deepest = std::min(trough, x.a_bottom);
  const double dwell = (trough * trough - deepest * deepest) / x.a_bottom;
  gap_end = x.a0 + x.a1 + 2 * deepest + dwell;
}

}  // namespace rmac
