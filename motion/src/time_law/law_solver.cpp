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

/// Where the iteration starts: the gap as a part of the travel time, and the least slack. Too near the bounds, and
/// steps are short; too far from them, and what a good guess knows is lost. Counted over the windows of bench_motion's
/// rose: with one start for both, the solver does half as much again.
struct StartingPoint {
  double gap, slack;
};
constexpr StartingPoint kFromProfile{10, 0.2};
constexpr StartingPoint kFromLaw{0.1, 0.02};

/// low <= phi(c) <= 1 on the three coefficients of one interval, two such rows at once, with slack and dual variable
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
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_}) v->resize(n_);
    step_.assign(n_, 0.0);
  }

  LawSolution run() {
    LawSolution result;
    const double count = 2 * static_cast<double>(kLanes * rows_.size());
    begin(start_.gap * travel_time() / count);
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      result.iterations = iteration + 1;
      const double mu = gap_ / count;
      if (!factorise()) break;
      solve_step();
      // Predictor: how far a pure Newton step gets tells how much to centre (Mehrotra).
      const Reach pure = follow<false>(0, 1);
      const double ratio = pure.gap / gap_;
      const double sigma = std::clamp(ratio * ratio, 1e-4, 0.8);
      aim(sigma * mu);
      solve_step();
      const Reach reach = follow<true>(sigma * mu, kBoundaryFraction);
      for (std::size_t j = 0; j < n_; ++j) c_[j] += reach.primal * step_[j];
      refresh(reach.primal, reach.dual);
      if (infeasible_ <= kFeasible && gap_ <= kGap * travel_time()) {
        result.converged = true;
        break;
      }
      if (reach.primal < 1e-9) break;
    }
    if (!result.converged) result.converged = infeasible_ <= 1e-5;  // feasible, if not proven optimal
    result.coefficients = std::move(c_);
    return result;
  }

 private:
  void fix_ends(const std::vector<double>& guess) {
    c_.assign(n_, 0.0);
    const std::size_t last = p_.intervals() - 1;
    if (guess.size() == n_) {
      c_ = guess;
      start_ = kFromLaw;
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

  [[nodiscard]] double travel_time() const {
    double t = 0;
    for (std::size_t k = 0; k < p_.intervals(); ++k) t += p_.step(k) / std::sqrt(std::max(c_[k + 1], 1e-30));
    return t;
  }

  /// Slacks that the rows have at the guess, or a least one, and duals that make all products `product`.
  void begin(double product) {
    for (Rows& rows : rows_) rows.above.slack = rows.below.slack = all_lanes(start_.slack);
    refresh(0, 0);
    for (Rows& rows : rows_) {
      for (Rows::Side* side : {&rows.above, &rows.below}) side->dual = all_lanes(product) * side->inverse_slack;
    }
    refresh(0, 0);
  }

  /// What the rows of one interval add to the normal matrix and its right side.
  struct Share {
    Lanes d0{}, d1{}, d2{}, near0{}, near1{}, far{};
    LaneTriple pull{};

    void add(const LaneTriple& g, Lanes ratio, Lanes weight) {
      const Lanes r0 = ratio * g[0], r1 = ratio * g[1];
      d0 += r0 * g[0];
      d1 += r1 * g[1];
      d2 += ratio * g[2] * g[2];
      near0 += r0 * g[1];
      near1 += r1 * g[2];
      far += r0 * g[2];
      for (std::size_t i = 0; i < 3; ++i) pull[i] += weight * g[i];
    }
  };

  /// Takes the steps of slacks and duals, looks at the rows anew where the coefficients are now (residuals phi - 1 +
  /// slack and low - phi + slack, gradients d phi / d c), and sets up Newton's equations. The objective is the sum of
  /// h/√c over the middle coefficients, which is the travel time up to second order and convex. All in one pass: time
  /// goes into loading the rows.
  void refresh(double primal_step, double dual_step) {
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_}) std::fill(v->begin(), v->end(), 0.0);
    const Lanes one = all_lanes(1), half = all_lanes(0.5);
    const Lanes primal = all_lanes(primal_step), dual = all_lanes(dual_step);
    Lanes infeasible{}, gap{};
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const LaneTriple c = lanes_of(c_.data() + k);
      Share share;
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) {
        Rows& rows = rows_[i];
        const Lanes root = rows.linear ? one : square_root(larger(dot(rows.u, c), all_lanes(1e-30)));
        const Lanes form = dot(rows.w, c);
        const Lanes phi = form * root;
        const Lanes bend = rows.linear ? Lanes{} : half * form / root;
        for (std::size_t x = 0; x < 3; ++x) rows.gradient[x] = root * rows.w[x] + bend * rows.u[x];
        const auto settle = [&](Rows::Side& side, Lanes excess) {
          infeasible = larger(infeasible, excess);
          // A side that turned out better than its slack takes it up at once: the linearisation never claims slack that
          // is not there.
          side.slack = larger(side.slack + primal * side.slack_step, -excess);
          side.dual += dual * side.dual_step;
          side.inverse_slack = one / side.slack;
          side.residual = excess + side.slack;
          gap += side.slack * side.dual;
        };
        settle(rows.above, phi - one);
        settle(rows.below, rows.low - phi);
        const Lanes above = rows.above.dual * rows.above.inverse_slack;
        const Lanes below = rows.below.dual * rows.below.inverse_slack;
        share.add(rows.gradient, above + below, above * rows.above.residual - below * rows.below.residual);
      }
      const double middle = c_[k + 1];
      const double force = 0.5 * p_.step(k) / (middle * std::sqrt(middle));
      diagonal_[k] += sum(share.d0);
      diagonal_[k + 1] += sum(share.d1) + 1.5 * force / middle;
      diagonal_[k + 2] += sum(share.d2);
      off1_[k] += sum(share.near0);
      off1_[k + 1] += sum(share.near1);
      off2_[k] += sum(share.far);
      rhs_[k + 1] += force;
      for (std::size_t x = 0; x < 3; ++x) rhs_[k + x] -= sum(share.pull[x]);
    }
    infeasible_ = largest(infeasible);
    gap_ = sum(gap);
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

  /// The steps of the coefficients, from the factors and the right side.
  void solve_step() {
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
  }

  /// What a side aims at for the product of its slack and dual: the centre, and what the predictor's steps would make
  /// of it.
  template <bool kSecondOrder>
  [[nodiscard]] [[gnu::always_inline]] static Lanes product(const Rows::Side& side, Lanes centre) {
    if constexpr (kSecondOrder) return centre - side.slack_step * side.dual_step;
    return centre;
  }

  /// Adds to the right side what aiming at other products than 0 means.
  void aim(double target) {
    const Lanes centre = all_lanes(target);
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      LaneTriple pull{};
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) {
        const Rows& rows = rows_[i];
        const Lanes weight = product<true>(rows.above, centre) * rows.above.inverse_slack -
                             product<true>(rows.below, centre) * rows.below.inverse_slack;
        for (std::size_t x = 0; x < 3; ++x) pull[x] += weight * rows.gradient[x];
      }
      for (std::size_t x = 0; x < 3; ++x) rhs_[k + x] -= sum(pull[x]);
    }
  }

  struct Reach {
    double primal, dual;
    double gap;  ///< what is left of it there
  };
  /// The steps of slacks and duals that go with those of the coefficients, and how far they may go before one of them
  /// falls to 1 - `fraction` of itself.
  template <bool kSecondOrder>
  Reach follow(double target, double fraction) {
    const Lanes centre = all_lanes(target);
    Lanes slack_fall = all_lanes(fraction), dual_fall = slack_fall;  // largest part of itself that one would lose
    Lanes by_slack{}, by_dual{}, by_both{};
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const LaneTriple step = lanes_of(step_.data() + k);
      for (std::size_t i = first_row_[k]; i < first_row_[k + 1]; ++i) {
        Rows& rows = rows_[i];
        const Lanes change = dot(rows.gradient, step);
        const auto take = [&](Rows::Side& side, Lanes slack_step) {
          const Lanes aimed = product<kSecondOrder>(side, centre);
          side.dual_step = (aimed - side.dual * slack_step) * side.inverse_slack - side.dual;
          side.slack_step = slack_step;
          slack_fall = larger(slack_fall, -slack_step * side.inverse_slack);
          dual_fall = larger(dual_fall, -side.dual_step / side.dual);
          by_slack += slack_step * side.dual;
          by_dual += side.slack * side.dual_step;
          by_both += slack_step * side.dual_step;
        };
        take(rows.above, -rows.above.residual - change);
        take(rows.below, -rows.below.residual + change);
      }
    }
    double primal = fraction / largest(slack_fall);
    // q itself must stay positive whatever the slacks say, or the next linearisation has no meaning.
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      if (0.9 * c_[j] < -primal * step_[j]) primal = -0.9 * c_[j] / step_[j];
    }
    const double dual = fraction / largest(dual_fall);
    return {primal, dual, gap_ + primal * sum(by_slack) + dual * sum(by_dual) + primal * dual * sum(by_both)};
  }

  const LawProblem& p_;
  std::size_t n_;
  std::size_t first_free_ = 0, end_free_ = 0;
  std::vector<Rows> rows_;
  std::vector<std::size_t> first_row_;  ///< of each interval, and behind the last
  std::vector<double> c_, step_, diagonal_, off1_, off2_, rhs_;
  StartingPoint start_ = kFromProfile;
  double infeasible_ = 0;  ///< largest excess over a bound
  double gap_ = 0;         ///< sum of slack times dual
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess) {
  return Solver(problem, guess).run();
}

}  // namespace rmac
