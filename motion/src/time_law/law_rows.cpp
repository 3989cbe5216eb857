#include "time_law/law_rows.hpp"

#include <algorithm>
#include <cmath>

#include "time_law/law_spline.hpp"

namespace rmac {
namespace {

/// Linear rows of one interval while they are collected, two beside each other.
class RowCollector {
 public:
  explicit RowCollector(std::vector<Rows>& all) : all_(all) {}

  /// low <= w·c <= high; a side that does not bind may be anything far away.
  void add(const Weights& w, double low, double high) {
    lane_ = (lane_ + 1) % kLanes;
    if (lane_ == 0) {
      // A lane that stays empty is a row of zeros, inside its bounds whatever the coefficients are.
      all_.emplace_back();
      all_.back().low = all_lanes(-1);
    }
    Rows& rows = all_.back();
    const double scale = 1 / high;
    for (std::size_t i = 0; i < 3; ++i) rows.gradient[i][lane_] = w[i] * scale;
    rows.low[lane_] = low * scale;
  }

 private:
  std::vector<Rows>& all_;
  std::size_t lane_ = kLanes - 1;
};

void path_acceleration_row(const LawBasis& b, double rise, double fall, RowCollector& rows) {
  const double most = std::isfinite(rise) ? rise : fall;
  if (!std::isfinite(most)) return;
  constexpr double kFarAway = 1e3;
  rows.add({b.dq[0] / 2, b.dq[1] / 2, b.dq[2] / 2}, -std::min(fall, kFarAway * most), std::min(rise, kFarAway * most));
}

void joint_acceleration_rows(const LawProblem& p, const LawBasis& b, const JointDerivatives& d, double tightening,
                             RowCollector& rows) {
  for (std::size_t j = 0; j < p.joint_count; ++j) {
    if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12) continue;
    Weights w;
    for (std::size_t i = 0; i < 3; ++i) w[i] = d.d2[j] * b.q[i] + 0.5 * d.d1[j] * b.dq[i];
    const double most = p.max_acceleration[j] * tightening;
    rows.add(w, -most, most);
  }
}

/// A joint's jerk is this times √q, as a part of its bound.
double jerk_weight(const LawProblem& p, std::size_t k, std::size_t j, const LawBasis& b, const JointDerivatives& d,
                   std::size_t i) {
  return (d.d3[j] * b.q[i] + 1.5 * d.d2[j] * b.dq[i] + 0.5 * d.d1[j] * b.ddq[i]) / (p.max_jerk[j] * p.tightening[k]);
}

void jerk_rows(const LawProblem& p, std::size_t k, const LawBasis& left, const LawBasis& right,
               std::vector<Rows>& all) {
  static_assert(kLanes == 2, "a lane for each end of the interval");
  const JointDerivatives at_left = p.at(k, false), at_right = p.at(k, true);
  for (std::size_t j = 0; j < p.joint_count; ++j) {
    if (!moves_on(p, k, j)) continue;
    Rows& rows = all.emplace_back();
    rows.low = all_lanes(-1);
    for (std::size_t i = 0; i < 3; ++i)
      rows.w[i] = Lanes{jerk_weight(p, k, j, left, at_left, i), jerk_weight(p, k, j, right, at_right, i)};
  }
}

RowGroup cut_rows(const LawProblem& p, const LawCut& cut, std::vector<Rows>& all) {
  const std::size_t k = cut.interval;
  const LawBasis b = basis_within(p, k, cut.part);
  const double* const d1 = cut.derivatives.data();
  const JointDerivatives d{d1, d1 + p.joint_count, d1 + 2 * p.joint_count};
  RowGroup group{k, all.size()};
  RowCollector rows(all);
  joint_acceleration_rows(p, b, d, p.tightening[k], rows);
  group.jerk = all.size();
  for (std::size_t i = 0; i < 3; ++i) group.q[i] = all_lanes(b.q[i]);
  for (std::size_t j = 0; j < p.joint_count; j += kLanes) {
    Rows& jerk = all.emplace_back();
    jerk.low = all_lanes(-1);
    for (std::size_t lane = 0; lane < kLanes && j + lane < p.joint_count; ++lane) {
      for (std::size_t i = 0; i < 3; ++i) jerk.w[i][lane] = jerk_weight(p, k, j + lane, b, d, i);
    }
  }
  return group;
}

}  // namespace

bool moves_on(const LawProblem& p, std::size_t k, std::size_t j) noexcept {
  const auto moves = [j](const JointDerivatives& d) {
    return std::abs(d.d1[j]) >= 1e-12 || std::abs(d.d2[j]) >= 1e-12 || std::abs(d.d3[j]) >= 1e-12;
  };
  return moves(p.at(k, false)) || moves(p.at(k, true));
}

LawRows::LawRows(const LawProblem& p) {
  const std::size_t n = p.intervals();
  all.reserve(n * ((p.joint_count + 2) / kLanes + 1 + p.joint_count) + p.cuts.size() * (p.joint_count + 1));
  groups.reserve(n + p.cuts.size() + 1);
  groups.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    groups[k].interval = k;
    groups[k].linear = all.size();
    RowCollector rows(all);
    // Nothing bounds the coefficients from below: the travel time does, which goes to infinity there.
    if (p.draft || (k > 0 && k + 1 < n)) rows.add({0, 1, 0}, -p.speed_cap[k], p.speed_cap[k]);
    const LawBasis left = basis(p, k, false), right = basis(p, k, true);
    if (k > 0) {
      const double cap = std::min(p.speed_cap[k], p.speed_cap[k - 1]);
      if (p.speed_cap[k] != p.speed_cap[k - 1]) rows.add(left.q, -cap, cap);
      path_acceleration_row(left, std::min(p.rise[k], p.rise[k - 1]), std::min(p.fall[k], p.fall[k - 1]), rows);
      joint_acceleration_rows(p, left, p.at(k, false), std::min(p.tightening[k], p.tightening[k - 1]), rows);
    }
    groups[k].jerk = all.size();
    for (std::size_t i = 0; i < 3; ++i) groups[k].q[i] = Lanes{left.q[i], right.q[i]};
    jerk_rows(p, k, left, right, all);
  }
  for (const LawCut& cut : p.cuts) groups.push_back(cut_rows(p, cut, all));
  groups.push_back({n, all.size()});
}

}  // namespace rmac
