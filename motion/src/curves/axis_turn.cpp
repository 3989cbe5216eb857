#include "axis_turn.hpp"

#include <numbers>

#include "rmac/motion/vector.hpp"

namespace rmac::curves {

Expected<AxisTurn> AxisTurn::between(const Vector& from, const Vector& to) {
  AxisTurn turn;
  turn.from_ = from;
  const Vector normal = cross(from, to);
  const double angle = std::atan2(norm(normal), dot(from, to));
  if (std::numbers::pi - angle < 1e-6) {
    return refuse(
        "the tool axis would turn by 180 degrees, and no great circle is shorter than the others: give a pose between");
  }
  if (norm(normal) > 0) {
    turn.across_ = cross(unit(normal), from);
    turn.angle_rad_ = angle;
  }
  return turn;
}

void AxisTurn::evaluate(double s, double length, int order, CurvePoint& point) const noexcept {
  const double rate = angle_rad_ / length;
  const double cosine = angle_rad_ > 0 ? std::cos(rate * s) : 1;
  const double sine = angle_rad_ > 0 ? std::sin(rate * s) : 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const double here = from_[c] * cosine + across_[c] * sine;
    const double ahead = rate * (across_[c] * cosine - from_[c] * sine);
    point.d[0][c + 3] = here;
    if (order >= 1) point.d[1][c + 3] = ahead;
    if (order >= 2) point.d[2][c + 3] = -rate * rate * here;
    if (order >= 3) point.d[3][c + 3] = -rate * rate * ahead;
  }
}

}  // namespace rmac::curves
