#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gives_way.hpp"
#include "lanes.hpp"
#include "time_law/law_rows.hpp"
#include "time_law/law_spline.hpp"

namespace rmac {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kBoundaryFraction = 0.99;
/// Gap of the duality measure at which a law counts as optimal, as a part of the travel time.
constexpr double kGap = 2e-4;
constexpr double kFeasible = 1e-7;
/// A law that is not proven optimal may exceed bounds by so much: they leave a margin, and the law is checked.
constexpr double kNearlyFeasible = 2e-4;

/// Where the iteration starts: the gap as a part of the travel time, and the least slack. Too near the bounds, and
/// steps are short; too far from them, and what a good guess knows is lost. Counted over the windows of bench_motion's
/// rose: with one start for both, the solver does half as much again.
struct StartingPoint {
  double gap, slack;
};
constexpr StartingPoint kFromProfile{10, 0.2};
constexpr StartingPoint kFromLaw{0.1, 0.02};

class Solver {
 public:
  Solver(const LawProblem& problem, const std::vector<double>& guess)
      : p_(problem), n_(problem.intervals() + 2), rows_(problem) {
    fix_ends(guess);
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_, &centre_pull_}) v->resize(n_);
    step_.assign(n_, 0.0);
  }

  LawSolution run() {
    LawSolution result;
    const double count = 2 * static_cast<double>(kLanes * rows_.all.size());
    begin(count);
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      if ((p_.work_left != nullptr && *p_.work_left <= 0) || gives_way()) return give_up(std::move(result));
      if (p_.work_left != nullptr) *p_.work_left -= static_cast<long>(p_.intervals());
      result.iterations = iteration + 1;
      const double mu = gap_ / count;
      if (!factorise()) break;
      solve_step();
      const double ratio = predicted_gap() / gap_;
      const double sigma = std::clamp(ratio * ratio, 1e-4, 0.8);
      for (std::size_t j = 0; j < n_; ++j) rhs_[j] -= sigma * mu * centre_pull_[j];
      solve_step();
      const Reach reach = correct(sigma * mu);
      for (std::size_t j = 0; j < n_; ++j) c_[j] += reach.primal * step_[j];
      refresh(reach.primal, reach.dual);
      if (infeasible_ <= kFeasible && gap_ <= kGap * travel_time_) {
        result.converged = true;
        break;
      }
      if (reach.primal < 1e-9) break;
    }
    if (!result.converged) result.converged = infeasible_ <= kNearlyFeasible;
    result.coefficients = std::move(c_);
    if (p_.draft) result.jerk_prices = jerk_prices();
    return result;
  }

 private:
  /// As far as it came; whoever asks for coefficients finds some.
  LawSolution give_up(LawSolution result) {
    result.coefficients = std::move(c_);
    if (p_.draft) result.jerk_prices = jerk_prices();
    return result;
  }

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
    if (p_.draft) {
      if (guess.empty()) c_.front() = c_[1], c_.back() = c_[n_ - 2];
      end_free_ = n_;
      return;
    }
    c_[0] = p_.begin.v * p_.begin.v;
    c_[1] = c_[0] + p_.begin.a * p_.step(0);
    c_[n_ - 1] = p_.end.v * p_.end.v;
    c_[n_ - 2] = c_[n_ - 1] - p_.end.a * p_.step(last);
    first_free_ = 2;
    end_free_ = n_ - 2;
  }

  [[nodiscard]] std::vector<double> jerk_prices() const {
    std::vector<double> prices(p_.intervals() * 2 * p_.joint_count, 0.0);
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      std::size_t row = rows_.groups[k].jerk;
      for (std::size_t j = 0; j < p_.joint_count; ++j) {
        if (!moves_on(p_, k, j)) continue;
        const Lanes both = rows_.all[row].above.dual + rows_.all[row].below.dual;
        for (std::size_t side = 0; side < 2; ++side) prices[(2 * k + side) * p_.joint_count + j] = both[side];
        ++row;
      }
    }
    return prices;
  }

  /// Slacks that the rows have at the guess, or a least one, and duals that make all products alike.
  void begin(double count) {
    for (std::size_t k = 0; k < p_.intervals(); ++k) travel_time_ += p_.step(k) / std::sqrt(std::max(c_[k + 1], 1e-30));
    for (Rows& rows : rows_.all) rows.above.slack = rows.below.slack = all_lanes(start_.slack);
    refresh<true>(0, 0, start_.gap * travel_time_ / count);
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
  template <bool kFirst = false>
  void refresh(double primal_step, double dual_step, double first_product = 0) {
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_, &centre_pull_}) std::fill(v->begin(), v->end(), 0.0);
    const Lanes one = all_lanes(1), half = all_lanes(0.5);
    const Lanes primal = all_lanes(primal_step), dual = all_lanes(dual_step);
    Lanes infeasible{}, gap{};
    double travel_time = 0;
    for (std::size_t g = 0; g + 1 < rows_.groups.size(); ++g) {
      const RowGroup& group = rows_.groups[g];
      const std::size_t k = group.interval;
      const LaneTriple c = lanes_of(c_.data() + k);
      Share share;
      const auto settle = [&](Rows::Side& side, Lanes excess) {
        infeasible = larger(infeasible, excess);
        // A side that turned out better than its slack takes it up at once: the linearisation never claims slack that
        // is not there.
        side.slack = larger(side.slack + primal * side.slack_step, -excess);
        side.inverse_slack = one / side.slack;
        side.dual = kFirst ? first_product * side.inverse_slack : side.dual + dual * side.dual_step;
        side.residual = excess + side.slack;
        gap += side.slack * side.dual;
      };
      const auto take = [&](Rows& rows, const LaneTriple& gradient, Lanes phi) {
        settle(rows.above, phi - one);
        settle(rows.below, rows.low - phi);
        const Lanes above = rows.above.dual * rows.above.inverse_slack;
        const Lanes below = rows.below.dual * rows.below.inverse_slack;
        share.add(gradient, above + below, above * rows.above.residual - below * rows.below.residual);
      };
      for (std::size_t i = group.linear; i < group.jerk; ++i)
        take(rows_.all[i], rows_.all[i].gradient, dot(rows_.all[i].gradient, c));
      const Lanes root = square_root(larger(dot(group.q, c), all_lanes(1e-30))), bending = half / root;
      for (std::size_t i = group.jerk; i < rows_.groups[g + 1].linear; ++i) {
        Rows& rows = rows_.all[i];
        const Lanes form = dot(rows.w, c), bend = form * bending;
        LaneTriple gradient;
        for (std::size_t x = 0; x < 3; ++x) gradient[x] = root * rows.w[x] + bend * group.q[x];
        rows.gradient = gradient;
        take(rows, gradient, form * root);
      }
      diagonal_[k] += sum(share.d0);
      diagonal_[k + 1] += sum(share.d1);
      diagonal_[k + 2] += sum(share.d2);
      off1_[k] += sum(share.near0);
      off1_[k + 1] += sum(share.near1);
      off2_[k] += sum(share.far);
      for (std::size_t x = 0; x < 3; ++x) rhs_[k + x] -= sum(share.pull[x]);
    }
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const double h = p_.step(k), middle = std::max(c_[k + 1], 1e-30), speed = std::sqrt(middle);
      const double inverse = 1 / (middle * speed), force = 0.5 * h * inverse;
      travel_time += h * middle * inverse;
      diagonal_[k + 1] += 1.5 * force * inverse * speed;
      rhs_[k + 1] += force;
    }
    infeasible_ = largest(infeasible);
    gap_ = sum(gap);
    travel_time_ = travel_time;
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

  /// Predictor: aims at products of 0. How much of all slack and dual is left at the end of the longest step tells how
  /// much to centre, and the product of both steps what curvature the corrector has to expect (Mehrotra). That goes to
  /// the right side here, and apart from it what centring would add, for all of which the rows are gone through once.
  double predicted_gap() {
    // With x the step of a slack as a part of it, the dual's is -(1 + x) of the dual.
    Lanes least = all_lanes(-1), most = all_lanes(0), first{}, second{};
    for (std::size_t g = 0; g + 1 < rows_.groups.size(); ++g) {
      const std::size_t k = rows_.groups[g].interval;
      const LaneTriple step = lanes_of(step_.data() + k);
      LaneTriple centre{}, product{};
      for (std::size_t i = rows_.groups[g].linear; i < rows_.groups[g + 1].linear; ++i) {
        Rows& rows = rows_.all[i];
        const Lanes change = dot(rows.gradient, step);
        const auto take = [&](Rows::Side& side, Lanes slack_step) {
          const Lanes x = slack_step * side.inverse_slack;
          const Lanes product_x = side.slack * side.dual * x, product_xx = product_x * x;
          least = smaller(least, x);
          most = larger(most, x);
          first += product_x;
          second += product_xx;
          side.product = product_x + product_xx;
        };
        take(rows.above, -rows.above.residual - change);
        take(rows.below, change - rows.below.residual);
        const Lanes to_centre = rows.above.inverse_slack - rows.below.inverse_slack;
        const Lanes to_product =
            rows.above.product * rows.above.inverse_slack - rows.below.product * rows.below.inverse_slack;
        for (std::size_t a = 0; a < 3; ++a) {
          centre[a] += to_centre * rows.gradient[a];
          product[a] += to_product * rows.gradient[a];
        }
      }
      for (std::size_t a = 0; a < 3; ++a) {
        centre_pull_[k + a] += sum(centre[a]);
        rhs_[k + a] -= sum(product[a]);
      }
    }
    const double x = sum(first), xx = sum(second);
    const double primal = within_positive(-1 / smallest(least)), dual = 1 / (1 + largest(most));
    return gap_ + primal * x - dual * (gap_ + x) - primal * dual * (x + xx);
  }

  /// Takes a quotient where it is larger. Only then it is worth its division, which is seldom.
  [[gnu::always_inline]] static void raise(Lanes& largest, Lanes numerator, Lanes denominator) {
    const LaneMask more = numerator > largest * denominator;
    if ((more[0] | more[1]) != 0) largest = larger(largest, numerator / denominator);
  }

  struct Reach {
    double primal, dual;
  };
  /// Corrector: the steps of slacks and duals that go with those of the coefficients, and how far they may go before
  /// one of them comes near its bound.
  Reach correct(double target) {
    const Lanes centre = all_lanes(target);
    Lanes slack_fall = all_lanes(kBoundaryFraction), dual_fall = slack_fall;  // largest part of itself that one loses
    for (std::size_t g = 0; g + 1 < rows_.groups.size(); ++g) {
      const std::size_t k = rows_.groups[g].interval;
      const LaneTriple step = lanes_of(step_.data() + k);
      for (std::size_t i = rows_.groups[g].linear; i < rows_.groups[g + 1].linear; ++i) {
        Rows& rows = rows_.all[i];
        const Lanes change = dot(rows.gradient, step);
        const auto take = [&](Rows::Side& side, Lanes slack_step) {
          side.slack_step = slack_step;
          side.dual_step = (centre + side.product - side.dual * slack_step) * side.inverse_slack - side.dual;
          slack_fall = larger(slack_fall, -slack_step * side.inverse_slack);
          raise(dual_fall, -side.dual_step, side.dual);
        };
        take(rows.above, -rows.above.residual - change);
        take(rows.below, change - rows.below.residual);
      }
    }
    return {within_positive(kBoundaryFraction / largest(slack_fall)), kBoundaryFraction / largest(dual_fall)};
  }

  /// q itself must stay positive whatever the slacks say, or the next linearisation has no meaning.
  [[nodiscard]] double within_positive(double primal) const {
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      if (0.9 * c_[j] < -primal * step_[j]) primal = -0.9 * c_[j] / step_[j];
    }
    return primal;
  }

  const LawProblem& p_;
  std::size_t n_;
  std::size_t first_free_ = 0, end_free_ = 0;
  LawRows rows_;
  std::vector<double> c_, step_, diagonal_, off1_, off2_, rhs_;
  std::vector<double> centre_pull_;  ///< what the right side loses where products of 1 are aimed at
  StartingPoint start_ = kFromProfile;
  double infeasible_ = 0;  ///< largest excess over a bound
  double gap_ = 0;         ///< sum of slack times dual
  double travel_time_ = 0;
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess) {
  return Solver(problem, guess).run();
}

}  // namespace rmac
