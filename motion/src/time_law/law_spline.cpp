#include "time_law/law_spline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rmac {

LawBasis basis(const LawProblem& p, std::size_t k, bool right) noexcept {
  const std::size_t n = p.intervals();
  const double h = p.step(k);
  const double before = k > 0 ? p.step(k - 1) : 0;
  const double after = k + 1 < n ? p.step(k + 1) : 0;
  const double per_left = 1 / (before + h), per_right = 1 / (h + after);
  const double a = h * per_left, b = before * per_left;   // q at the left node
  const double c = after * per_right, d = h * per_right;  // q at the right node
  LawBasis result{};
  if (right) {
    result.q = {0, c, d};
    result.dq = {0, -2 * per_right, 2 * per_right};
  } else {
    result.q = {a, b, 0};
    result.dq = {-2 * per_left, 2 * per_left, 0};
  }
  const double s = 2 / (h * h);
  result.ddq = {a * s, (b + c - 2) * s, d * s};
  return result;
}

LawBasis basis_within(const LawProblem& p, std::size_t k, double part) noexcept {
  LawBasis b = basis(p, k, false);
  const double ds = part * p.step(k);
  for (std::size_t i = 0; i < 3; ++i) {
    b.q[i] += ds * (b.dq[i] + ds / 2 * b.ddq[i]);
    b.dq[i] += ds * b.ddq[i];
  }
  return b;
}

/// A profile not far from what the bounds allow: at each place no faster than curvature and its change would permit
/// at constant speed, and from place to place growing no faster than a part of the acceleration permits; then
/// smoothed, because a kink is jerk.
void guess_coefficients(const LawProblem& p, std::vector<double>& c) {
  const std::size_t n = p.intervals();
  std::vector<double> node(n + 1), slope(n);
  const auto permitted = [&](const JointDerivatives& d) {
    double q = std::numeric_limits<double>::infinity(), cubed = q;  // bounds of q, and of q^(3/2)
    for (std::size_t j = 0; j < p.joint_count; ++j) {
      if (d.d2[j] != 0) q = std::min(q, 0.4 * p.max_acceleration[j] / std::abs(d.d2[j]));
      if (d.d3[j] != 0) cubed = std::min(cubed, 0.2 * p.max_jerk[j] / std::abs(d.d3[j]));
    }
    return std::min(q, std::pow(cubed, 2.0 / 3));
  };
  for (double& q : node) q = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < n; ++k) {
    const JointDerivatives left = p.at(k, false), right = p.at(k, true);
    node[k] = std::min({node[k], 0.7 * p.speed_cap[k], permitted(left)});
    node[k + 1] = std::min({node[k + 1], 0.7 * p.speed_cap[k], permitted(right)});
    double limit = std::min(p.rise[k], p.fall[k]);
    for (std::size_t j = 0; j < p.joint_count; ++j) {
      if (std::abs(left.d1[j]) > 1e-9) limit = std::min(limit, p.max_acceleration[j] / std::abs(left.d1[j]));
    }
    slope[k] = 0.5 * limit;
  }
  const double first = p.draft ? node[0] : p.begin.v * p.begin.v, last = p.draft ? node[n] : p.end.v * p.end.v;
  node[0] = first;
  for (std::size_t k = 0; k < n; ++k) node[k + 1] = std::min(node[k + 1], node[k] + slope[k] * p.step(k));
  node[n] = last;
  for (std::size_t k = n; k-- > 0;) node[k] = std::min(node[k], node[k + 1] + slope[k] * p.step(k));
  node[0] = first;
  for (int pass = 0; pass < 4; ++pass) {
    double before = node[0];
    for (std::size_t k = 1; k < n; ++k) {
      const double here = node[k];
      node[k] = std::min(here, 0.25 * before + 0.5 * here + 0.25 * node[k + 1]);
      before = here;
    }
  }
  for (std::size_t k = 0; k < n; ++k) c[k + 1] = 0.5 * (node[k] + node[k + 1]);
}

SplineStart spline_start(const LawProblem& p, const std::vector<double>& c, std::size_t k) noexcept {
  const LawBasis b = basis(p, k, false);
  return {dot(b.q, c.data() + k), dot(b.dq, c.data() + k), dot(b.ddq, c.data() + k)};
}

std::vector<LawPiece> law_pieces(const LawProblem& p, const std::vector<double>& c, double t0) {
  std::vector<LawPiece> pieces;
  pieces.reserve(p.intervals());
  PathState state = p.begin;
  for (std::size_t k = 0; k < p.intervals(); ++k) {
    const SplineStart start = spline_start(p, c, k);
    const double h = p.step(k);
    LawPiece piece;
    piece.kind = LawPiece::Kind::Linear;
    piece.t0 = t0;
    piece.start = {p.nodes[k], k == 0 ? state.v : std::sqrt(start.q), k == 0 ? state.a : start.dq / 2};
    piece.slope = start.ddq / 2;
    // eq. 6: tanh(wT/2) = w h / (v0 + v1), with w² the slope of a(s).
    const double v1 = std::sqrt(std::max(start.q + h * (start.dq + h * start.ddq / 2), 0.0));
    const double mean = h / (piece.start.v + v1);
    const double z2 = piece.slope * mean * mean;
    double shape = 0;
    if (std::abs(z2) < 1e-3) {
      shape = 1 + z2 * (1.0 / 3 + z2 * (1.0 / 5 + z2 * (1.0 / 7 + z2 * (1.0 / 9 + z2 / 11))));
    } else if (z2 > 0) {
      const double z = std::sqrt(z2);
      shape = std::atanh(z) / z;
    } else {
      const double z = std::sqrt(-z2);
      shape = std::atan(z) / z;
    }
    piece.duration = 2 * mean * shape;
    t0 += piece.duration;
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace rmac
