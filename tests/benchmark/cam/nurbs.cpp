// Curves that arrive as mathematics, against the fastest law that an independent program finds on them.
#include <cmath>
#include <numbers>

#include "../motion/machines.hpp"
#include "../motion/shapes.hpp"
#include "program.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

constexpr double kRound = 2 * std::numbers::pi;
constexpr double kWithin = 1.02;

/// NACA 4412, 90 mm long, from the trailing edge over the nose and back; in ±45 mm.
Vector airfoil(double angle) {
  constexpr double kChord_mm = 90, kThickness = 0.12, kCamber = 0.04, kCrest = 0.4;
  const double root = 1 - angle / std::numbers::pi, x = root * root, side = root < 0 ? -1 : 1;
  const double half =
      5 * kThickness * (0.2969 * std::abs(root) - x * (0.1260 + x * (0.3516 - x * (0.2843 - 0.1015 * x))));
  const double from = x < kCrest ? kCrest : 1 - kCrest, to_crest = kCrest - x;
  const double camber = kCamber * (1 - to_crest * to_crest / (from * from));
  const double slope = std::atan(2 * kCamber * to_crest / (from * from));
  return {kChord_mm * (x - side * half * std::sin(slope) - 0.5), kChord_mm * (camber + side * half * std::cos(slope)),
          0};
}

/// `optimum_s`: by a sequence of linear programs in the squared speed at 1501 places, under the same limits of speed,
/// acceleration and jerk of each axis; at 3001 and 5001 places it finds up to 0.5 % more.
void against_optimum(Figures& figures, const std::string& name, const Nurbs& nurbs, double optimum_s) {
  const auto done = machine(nurbs, 0.01, 200, bench_xyz());
  if (!done) {
    figures.missing(name, "<= " + std::to_string(kWithin), "of the optimum", done.error());
    return;
  }
  figures.at_most(name, done->time_s / optimum_s, kWithin, "of the optimum", std::to_string(done->time_s) + " s");
  figures.at_most(name + "_limits", done->limits, 1.001, "of limit");
}

}  // namespace

void nurbs_rows(Figures& figures, const Extent&) {
  against_optimum(figures, "airfoil_nurbs", interpolated(airfoil, kRound, 5, 120), 1.4090);
  against_optimum(figures, "butterfly_nurbs", interpolated(butterfly, kRound, 5, 600), 3.5927);
}

}  // namespace rmac::bench
