#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "lanes.hpp"
#include "time_law/law_spline.hpp"

namespace rmac {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kBoundaryFraction = 0.99;
/// Gap of the duality measure at which a law counts as optimal, as a part of the travel time.
constexpr double kGap = 2e-4;
constexpr double kFeasible = 1e-7;

/// low <= phi(c) <= 1 on the three coefficients of one interval, some such rows at once, with slack and dual variable
/// of both sides. Most of the time of a plan is spent going through these, so what belongs together lies together, both
/// sides share one gradient, and rows of an interval share the coefficients that they touch.
/// phi = w·c, or for jerk (w·c)·√(u·c), eq. 10, u·c being q at an end of the interval.
struct Rows {
  LaneTriple w{}, u{}, gradient{};
  Lanes low{};
  LaneMask linear{};
  struct Side {
    Lanes slack{}, inverse_slack{}, dual{}, residual{}, slack_step{}, dual_step{};
  };
  Side above, below;
};

/// Rows of one interval while they are collected.
class RowCollector {
 public:
  explicit RowCollector(std::vector<Rows>& all) : all_(all) {}

  /// low <= w·c <= high; a side that does not bind may be anything far away.
  void add_linear(const Weights& w, double low, double high) {
    Rows& rows = next();
    for (std::size_t i = 0; i < 3; ++i) rows.w[i][lane_] = w[i] / high;
    rows.low[lane_] = low / high;
  }
  /// |(w·c)·√(u·c)| <= 1.
  void add_jerk(const Weights& w, const Weights& u) {
    Rows& rows = next();
    for (std::size_t i = 0; i < 3; ++i) rows.w[i][lane_] = w[i], rows.u[i][lane_] = u[i];
    rows.linear[lane_] = 0;
  }
  void end_interval() { lane_ = kLanes - 1; }

 private:
  Rows& next() {
    lane_ = (lane_ + 1) % kLanes;
    if (lane_ == 0) {
      // A lane that stays empty is a row of zeros, inside its bounds whatever the coefficients are.
      all_.emplace_back();
      all_.back().low = all_lanes(-1);
      all_.back().linear = all_lanes(1) == all_lanes(1);
    }
    return all_.back();
  }

  std::vector<Rows>& all_;
  std::size_t lane_ = kLanes - 1;
};

class Solver {
 public:
  Solver(const LawProblem& problem, const std::vector<double>& guess) : p_(problem), n_(problem.intervals() + 2) {
    fix_ends(guess);
    build_rows();
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_, &objective_gradient_}) v->resize(n_);
    step_.assign(n_, 0.0);
  }

  LawSolution run() {
    LawSolution result;
    const double count = 2 * static_cast<double>(kLanes * rows_.size());
    evaluate(true);
    const Lanes first_dual = all_lanes(0.1 * travel_time() / count);
    for (Rows& rows : rows_) {
      for (Rows::Side* side : {&rows.above, &rows.below}) side->dual = first_dual * side->inverse_slack;
    }
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      result.iterations = iteration + 1;
      const double mu = complementarity(0, 0) / count;
      assemble();
      if (!factorise()) break;
      // Predictor: how far a pure Newton step gets tells how much to centre (Mehrotra).
      direction<false>(0);
      const auto [reach_p, reach_d] = reaches(1);
      const double ratio = complementarity(reach_p, reach_d) / count / mu;
      const double sigma = std::clamp(ratio * ratio * ratio, 1e-4, 0.8);
      direction<true>(sigma * mu);
      const auto [alpha_p, alpha_d] = reaches(kBoundaryFraction);
      for (std::size_t j = 0; j < n_; ++j) c_[j] += alpha_p * step_[j];
      const Lanes primal = all_lanes(alpha_p), dual = all_lanes(alpha_d);
      for (Rows& rows : rows_) {
        for (Rows::Side* side : {&rows.above, &rows.below}) {
          side->slack += primal * side->slack_step;
          side->dual += dual * side->dual_step;
        }
      }
      const double infeasible = evaluate(false);
      if (infeasible <= kFeasible && complementarity(0, 0) <= kGap * travel_time()) {
        result.converged = true;
        break;
      }
      if (alpha_p < 1e-9) break;
    }
    if (!result.converged) result.converged = evaluate(false) <= 1e-5;  // feasible, if not proven optimal
    result.coefficients = std::move(c_);
    return result;
  }

 private:
  void fix_ends(const std::vector<double>& guess) {
    c_.assign(n_, 0.0);
    const std::size_t last = p_.intervals() - 1;
    if (guess.size() == n_) {
      c_ = guess;
    } else {
      guess_coefficients(p_, c_);
      for (std::size_t i = 0; i < p_.travelled_before.size(); ++i) c_[i] = std::max(c_[i], p_.travelled_before[i]);
    }
    c_[0] = p_.begin.v * p_.begin.v;
    c_[1] = c_[0] + p_.begin.a * p_.step(0);
    c_[n_ - 1] = p_.end.v * p_.end.v;
    c_[n_ - 2] = c_[n_ - 1] - p_.end.a * p_.step(last);
    first_free_ = 2;
    end_free_ = n_ - 2;
  }

  void build_rows() {
    const std::size_t n = p_.intervals();
    rows_.reserve(n * ((3 * p_.joint_count + 2) / kLanes + 1));
    first_row_.reserve(n + 1);
    RowCollector rows(rows_);
    for (std::size_t k = 0; k < n; ++k) {
      first_row_.push_back(rows_.size());
      // Nothing bounds the coefficients from below: the travel time does, which goes to infinity there.
      if (k + 1 >= first_free_ && k + 1 < end_free_) rows.add_linear({0, 1, 0}, -p_.speed_cap[k], p_.speed_cap[k]);
      const Basis left = basis(p_, k, false), right = basis(p_, k, true);
      if (k > 0) {
        const double cap = std::min(p_.speed_cap[k], p_.speed_cap[k - 1]);
        if (p_.speed_cap[k] != p_.speed_cap[k - 1]) rows.add_linear(left.q, -cap, cap);
        path_acceleration_row(left, std::min(p_.rise[k], p_.rise[k - 1]), std::min(p_.fall[k], p_.fall[k - 1]), rows);
        joint_acceleration_rows(left, p_.at(k, false), std::min(p_.tightening[k], p_.tightening[k - 1]), rows);
      }
      jerk_rows(left, p_.at(k, false), p_.tightening[k], rows);
      jerk_rows(right, p_.at(k, true), p_.tightening[k], rows);
      rows.end_interval();
    }
    first_row_.push_back(rows_.size());
  }

  static void path_acceleration_row(const Basis& b, double rise, double fall, RowCollector& rows) {
    const double most = std::isfinite(rise) ? rise : fall;
    if (!std::isfinite(most)) return;
    constexpr double kFarAway = 1e3;
    rows.add_linear({b.dq[0] / 2, b.dq[1] / 2, b.dq[2] / 2}, -std::min(fall, kFarAway * most),
                    std::min(rise, kFarAway * most));
  }

  void joint_acceleration_rows(const Basis& b, const JointDerivatives& d, double tightening, RowCollector& rows) const {
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12) continue;
      Weights w;
      for (std::size_t i = 0; i < 3; ++i) w[i] = d.d2[j] * b.q[i] + 0.5 * d.d1[j] * b.dq[i];
      const double most = p_.max_acceleration[j] * tightening;
      rows.add_linear(w, -most, most);
    }
  }

  void jerk_rows(const Basis& b, const JointDerivatives& d, double tightening, RowCollector& rows) const {
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12 && std::abs(d.d3[j]) < 1e-12) continue;
      const double scale = 1 / (p_.max_jerk[j] * tightening);
      Weights w;
      for (std::size_t i = 0; i < 3; ++i)
        w[i] = (d.d3[j] * b.q[i] + 1.5 * d.d2[j] * b.dq[i] + 0.5 * d.d1[j] * b.ddq[i]) * scale;
      rows.add_jerk(w, b.q);
    }
  }

  /// Calls visit(rows, k) for each few rows, k being the first of their interval's coefficients.
  template <typename Visit>
  void each(Visit visit) {
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) visit(rows_[i], k);
    }
  }

  /// Residuals phi - 1 + slack and low - phi + slack, gradients d phi / d c, and the largest excess over a bound.
  double evaluate(bool first) {
    const Lanes one = all_lanes(1), half = all_lanes(0.5), least_slack = all_lanes(0.02);
    Lanes infeasible{};
    each([&](Rows& rows, std::size_t k) {
      const LaneTriple c = lanes_of(c_.data() + k);
      const Lanes q = larger(dot(rows.u, c), all_lanes(1e-30));
      const Lanes root = rows.linear ? one : square_root(q);
      const Lanes form = dot(rows.w, c);
      const Lanes phi = form * root;
      const Lanes bend = rows.linear ? Lanes{} : half * form / root;
      for (std::size_t i = 0; i < 3; ++i) rows.gradient[i] = root * rows.w[i] + bend * rows.u[i];
      const auto settle = [&](Rows::Side& side, Lanes excess) {
        infeasible = larger(infeasible, excess);
        // A side that turned out better than its slack takes it up at once: the linearisation never claims slack that
        // is not there.
        side.slack = larger(first ? least_slack : side.slack, -excess);
        side.inverse_slack = one / side.slack;
        side.residual = excess + side.slack;
      };
      settle(rows.above, phi - one);
      settle(rows.below, rows.low - phi);
    });
    return largest(infeasible);
  }

  [[nodiscard]] double travel_time() const {
    double t = 0;
    for (std::size_t k = 0; k < p_.intervals(); ++k) t += p_.step(k) / std::sqrt(std::max(c_[k + 1], 1e-30));
    return t;
  }

  /// Sum of slack times dual, after steps of these lengths.
  [[nodiscard]] double complementarity(double primal_step, double dual_step) const {
    const Lanes primal = all_lanes(primal_step), dual = all_lanes(dual_step);
    Lanes total{};
    for (const Rows& rows : rows_) {
      const Rows::Side &a = rows.above, &b = rows.below;
      total += (a.slack + primal * a.slack_step) * (a.dual + dual * a.dual_step);
      total += (b.slack + primal * b.slack_step) * (b.dual + dual * b.dual_step);
    }
    return sum(total);
  }

  /// Objective: the sum of h/√c over the middle coefficients, which is the travel time up to second order and convex.
  void assemble() {
    for (auto* v : {&diagonal_, &off1_, &off2_, &objective_gradient_}) std::fill(v->begin(), v->end(), 0.0);
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const double c = c_[k + 1], h = p_.step(k);
      const double force = 0.5 * h / (c * std::sqrt(c));
      objective_gradient_[k + 1] = -force;
      diagonal_[k + 1] += 1.5 * force / c;
      Lanes d0{}, d1{}, d2{}, near0{}, near1{}, far{};
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) {
        const Rows& rows = rows_[i];
        const auto& [g0, g1, g2] = rows.gradient;
        const Lanes ratio = rows.above.dual * rows.above.inverse_slack + rows.below.dual * rows.below.inverse_slack;
        const Lanes r0 = ratio * g0, r1 = ratio * g1;
        d0 += r0 * g0;
        d1 += r1 * g1;
        d2 += ratio * g2 * g2;
        near0 += r0 * g1;
        near1 += r1 * g2;
        far += r0 * g2;
      }
      diagonal_[k] += sum(d0);
      diagonal_[k + 1] += sum(d1);
      diagonal_[k + 2] += sum(d2);
      off1_[k] += sum(near0);
      off1_[k + 1] += sum(near1);
      off2_[k] += sum(far);
    }
  }

  /// LDLᵀ of the pentadiagonal matrix over the free coefficients, in place; the diagonal is left inverted.
  bool factorise() {
    double before1 = 0, before2 = 0;  // D of the two rows before
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      double d = diagonal_[j];
      double l1 = off1_[j];
      if (j >= first_free_ + 1) {
        d -= off1_[j - 1] * off1_[j - 1] * before1;
        l1 -= off1_[j - 1] * off2_[j - 1] * before1;
      }
      if (j >= first_free_ + 2) d -= off2_[j - 2] * off2_[j - 2] * before2;
      if (!(d > 0) || !std::isfinite(d)) return false;
      const double inverse = 1 / d;
      diagonal_[j] = inverse;
      off1_[j] = j + 1 < end_free_ ? l1 * inverse : 0;
      off2_[j] = j + 2 < end_free_ ? off2_[j] * inverse : 0;
      before2 = before1;
      before1 = d;
    }
    return true;
  }

  template <bool kSecondOrder>
  void direction(double target) {
    const Lanes centre = all_lanes(target);
    const auto aim = [centre](const Rows::Side& side) {
      if constexpr (kSecondOrder) return centre - side.slack_step * side.dual_step;
      return centre;
    };
    for (std::size_t j = 0; j < n_; ++j) rhs_[j] = -objective_gradient_[j];
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      LaneTriple pull{};
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) {
        const Rows& rows = rows_[i];
        const auto force = [&](const Rows::Side& side) {
          return (aim(side) + side.dual * side.residual) * side.inverse_slack;
        };
        const Lanes weight = force(rows.above) - force(rows.below);
        for (std::size_t c = 0; c < 3; ++c) pull[c] += weight * rows.gradient[c];
      }
      for (std::size_t c = 0; c < 3; ++c) rhs_[k + c] -= sum(pull[c]);
    }
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      double value = rhs_[j];
      if (j >= first_free_ + 1) value -= off1_[j - 1] * step_[j - 1];
      if (j >= first_free_ + 2) value -= off2_[j - 2] * step_[j - 2];
      step_[j] = value;
    }
    for (std::size_t j = end_free_; j-- > first_free_;) {
      double value = step_[j] * diagonal_[j];
      if (j + 1 < end_free_) value -= off1_[j] * step_[j + 1];
      if (j + 2 < end_free_) value -= off2_[j] * step_[j + 2];
      step_[j] = value;
    }
    each([&](Rows& rows, std::size_t k) {
      const Lanes change = dot(rows.gradient, lanes_of(step_.data() + k));
      const auto follow = [&](Rows::Side& side, Lanes slack_step) {
        side.dual_step = (aim(side) - side.dual * slack_step) * side.inverse_slack - side.dual;
        side.slack_step = slack_step;
      };
      follow(rows.above, -rows.above.residual - change);
      follow(rows.below, -rows.below.residual + change);
    });
  }

  struct Reach {
    double primal, dual;
  };
  /// How far the steps may go before a slack or a dual falls to 1 - `fraction` of itself.
  [[nodiscard]] Reach reaches(double fraction) const {
    Lanes slack_fall = all_lanes(fraction), dual_fall = slack_fall;  // largest part of itself that one would lose
    for (const Rows& rows : rows_) {
      for (const Rows::Side* side : {&rows.above, &rows.below}) {
        slack_fall = larger(slack_fall, -side->slack_step * side->inverse_slack);
        dual_fall = larger(dual_fall, -side->dual_step / side->dual);
      }
    }
    double primal = fraction / largest(slack_fall);
    // q itself must stay positive whatever the slacks say, or the next linearisation has no meaning.
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      if (0.9 * c_[j] < -primal * step_[j]) primal = -0.9 * c_[j] / step_[j];
    }
    return {primal, fraction / largest(dual_fall)};
  }

  const LawProblem& p_;
  std::size_t n_;
  std::size_t first_free_ = 0, end_free_ = 0;
  std::vector<Rows> rows_;
  std::vector<std::size_t> first_row_;  ///< of each interval, and behind the last
  std::vector<double> c_, step_, diagonal_, off1_, off2_, rhs_, objective_gradient_;
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess) {
  return Solver(problem, guess).run();
}

}  // namespace rmac
