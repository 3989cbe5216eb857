#include "shortest_stop.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::bench {
namespace {

constexpr double kStep_s = 2e-4;

struct End {
  bool too_late = false;  ///< speed came to zero before the acceleration did
  double s = 0;
};

End brake(const PathSegment& segment, const std::vector<JointLimits>& joints, PathState at, double t_switch) {
  JointPoint p;
  for (double t = 0; t < 20; t += kStep_s) {
    if (at.v <= 0) return {true, at.s};
    if (t >= t_switch && at.a >= 0) return {false, at.s};
    if (at.s >= segment.length() || segment.evaluate(at.s, 3, 1, p) != KinematicsStatus::Ok) return {true, NAN};
    double a_low = -1e300, j_low = -1e300, j_high = 1e300;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double d = std::abs(p.d[1][j]), sign = p.d[1][j] < 0 ? -1 : 1;
      if (d < 1e-6) continue;
      const double bend = sign * p.d[2][j] * at.v * at.v;
      a_low = std::max(a_low, (-joints[j].max_acceleration - bend) / d);
      const double rest = sign * (p.d[3][j] * at.v * at.v * at.v + 3 * p.d[2][j] * at.v * at.a);
      j_low = std::max(j_low, (-joints[j].max_jerk - rest) / d);
      j_high = std::min(j_high, (joints[j].max_jerk - rest) / d);
    }
    const double jerk = t < t_switch ? std::max(j_low, std::min((a_low - at.a) / kStep_s, j_high)) : j_high;
    at.s += kStep_s * (at.v + kStep_s * (at.a / 2 + kStep_s * jerk / 6));
    at.v += kStep_s * (at.a + kStep_s * jerk / 2);
    at.a += kStep_s * jerk;
  }
  return {true, NAN};
}

}  // namespace

double shortest_stop_mm(const PathSegment& segment, const std::vector<JointLimits>& joints, const PathState& from) {
  double early = 0, late = 2;
  for (int i = 0; i < 22; ++i) {
    const double middle = (early + late) / 2;
    (brake(segment, joints, from, middle).too_late ? late : early) = middle;
  }
  return brake(segment, joints, from, late).s - from.s;
}

}  // namespace rmac::bench
