#include <algorithm>
#include <cmath>

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
bool even(double most, double least, double step) {
  constexpr double kChange = 0.15;
  constexpr double kChange_rad = 0.005;
  const double change = most - least;
  return most * step <= kNodeTurn_rad && (change <= kChange * most || change * step <= kChange_rad);
}

/// `inside`: bends known between a and b, ascending.
void halve(const Curve& curve, const Bend& a, const Bend& b, std::span<const Bend> inside, int least_depth,
           std::vector<double>& nodes) {
  const double step = b.s - a.s;
  if (step >= 2 * kNodeSpacing) {
    const Bend m = bend_at(curve, a.s + step / 2, 1);
    const auto uneven = [&](double Bend::*bend) {
      double most = std::max({a.*bend, m.*bend, b.*bend}), least = std::min({a.*bend, m.*bend, b.*bend});
      for (const Bend& known : inside) most = std::max(most, known.*bend), least = std::min(least, known.*bend);
      return !even(most, least, step);
    };
    if (least_depth > 0 || uneven(&Bend::path) || uneven(&Bend::axis)) {
      const auto middle = std::partition_point(inside.begin(), inside.end(), [&](const Bend& k) { return k.s < m.s; });
      const auto before = static_cast<std::size_t>(middle - inside.begin());
      halve(curve, a, m, inside.first(before), least_depth - 1, nodes);
      halve(curve, m, b, inside.subspan(before), least_depth - 1, nodes);
      return;
    }
  }
  nodes.push_back(b.s);
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
    halve(curve, bend_at(curve, knots[i], 1), bend_at(curve, knots[i + 1], -1), inside, 2, nodes);
  }
  return nodes;
}

}  // namespace rmac::curves
