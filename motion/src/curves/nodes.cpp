#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "build.hpp"

namespace rmac::curves {
namespace {

/// What bends at one place of a curve: curvature of the tip (or joint) path, rate and change of rate of the tool axis.
struct Bend {
  double s = 0;
  double path = 0;
  double axis = 0;
};

double length_of(const CurvePoint& point, std::size_t order, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t c = first; c < last; ++c) sum += point.d[order][c] * point.d[order][c];
  return std::sqrt(sum);
}

Bend bend_at(const Curve& curve, double s, int side) {
  CurvePoint point;
  curve.evaluate(s, 2, side, point);
  if (curve.in_joint_space()) return {s, length_of(point, 2, 0, curve.dimension()), 0};
  return {s, length_of(point, 2, 0, 3), length_of(point, 1, 3, 6)};
}

/// Small turn, and a change of bend that is small relative to it or in the angle it makes (section 5 of the
/// derivation).
bool bends_evenly(double most, double least, double step) {
  constexpr double kChange = 0.15;
  constexpr double kChange_rad = 0.005;
  const double change = most - least;
  return most * step <= kNodeTurn_rad && (change <= kChange * most || change * step <= kChange_rad);
}

/// Bends at the ends, the quarters and the middle of a stretch.
using Five = std::array<Bend, 5>;

/// `inside`: more bends known between the ends, ascending.
void halve(const Curve& curve, const Five& known, std::span<const Bend> inside, std::vector<double>& nodes) {
  const double step = known[4].s - known[0].s;
  const auto uneven = [&](double Bend::*bend) {
    double most = 0, least = std::numeric_limits<double>::infinity();
    for (const Bend& here : known) most = std::max(most, here.*bend), least = std::min(least, here.*bend);
    for (const Bend& here : inside) most = std::max(most, here.*bend), least = std::min(least, here.*bend);
    return !bends_evenly(most, least, step);
  };
  if (step >= 2 * kNodeSpacing && (uneven(&Bend::path) || uneven(&Bend::axis))) {
    const auto middle =
        std::partition_point(inside.begin(), inside.end(), [&](const Bend& k) { return k.s < known[2].s; });
    const auto before = static_cast<std::size_t>(middle - inside.begin());
    const auto half = [&](std::size_t i) {
      const double quarter = (known[i + 2].s - known[i].s) / 4;
      return Five{known[i], bend_at(curve, known[i].s + quarter, 1), known[i + 1],
                  bend_at(curve, known[i].s + 3 * quarter, 1), known[i + 2]};
    };
    halve(curve, half(0), inside.first(before), nodes);
    halve(curve, half(2), inside.subspan(before), nodes);
    return;
  }
  nodes.push_back(known[4].s);
}

}  // namespace

std::vector<double> even_nodes(double length, double turn_rad) {
  const double most = std::max(1.0, std::floor(length / kNodeSpacing));
  const double count = std::clamp(std::ceil(turn_rad / kNodeTurn_rad), 1.0, most);
  std::vector<double> nodes(static_cast<std::size_t>(count) + 1);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = length * static_cast<double>(i) / count;
  nodes.back() = length;
  return nodes;
}

std::vector<double> curvature_nodes(const Curve& curve, std::span<const double> knots, std::span<const double> probes) {
  std::vector<double> nodes{0};
  std::vector<Bend> inside;
  auto probe = probes.begin();
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    inside.clear();
    while (probe != probes.end() && *probe <= knots[i]) ++probe;
    for (; probe != probes.end() && *probe < knots[i + 1]; ++probe) inside.push_back(bend_at(curve, *probe, 1));
    const double from = knots[i], width = knots[i + 1] - from;
    const auto at = [&](double part) { return bend_at(curve, from + part * width, 1); };
    halve(curve, {at(0), at(0.25), at(0.5), at(0.75), bend_at(curve, knots[i + 1], -1)}, inside, nodes);
  }
  return nodes;
}

}  // namespace rmac::curves
