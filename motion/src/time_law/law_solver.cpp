#include <algorithm>
#include <cmath>
#include <cstdint>

#include "time_law/law_spline.hpp"

namespace rmac {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kBoundaryFraction = 0.99;
/// Gap of the duality measure at which a law counts as optimal, as a part of the travel time.
constexpr double kGap = 2e-4;
constexpr double kFeasible = 1e-7;

/// One end of an interval as jerk bands see it: q there, and its root.
struct Place {
  std::uint32_t first = 0;
  Weights u{};
  double root = 0, half_inverse_root = 0;
};

constexpr std::uint32_t kLinear = 0xffffffff;

/// low <= phi(c) <= 1 on three neighbouring coefficients, with slack and dual variable of both sides: most of the time
/// of a plan is spent going through these, so what belongs together lies together and both sides share one gradient.
/// Linear: phi = w·c. Jerk: phi = (w·c)·√(u·c), eq. 10, u·c being q at `place`.
struct Band {
  std::uint32_t first = 0;
  std::uint32_t place = kLinear;
  double low = -1;
  Weights w{}, gradient{};
  struct Side {
    double slack = 0, inverse_slack = 0, dual = 0, residual = 0, slack_step = 0, dual_step = 0;
  };
  Side above, below;
};

class Solver {
 public:
  Solver(const LawProblem& problem, const std::vector<double>& guess) : p_(problem), n_(problem.intervals() + 2) {
    fix_ends(guess);
    build_bands();
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_, &objective_gradient_}) v->resize(n_);
    step_.assign(n_ + 2, 0.0);
  }

  LawSolution run() {
    LawSolution result;
    const double count = 2 * static_cast<double>(bands_.size());
    evaluate(true);
    const double first_dual = 0.1 * travel_time() / count;
    for (Band& band : bands_) {
      for (Band::Side* side : {&band.above, &band.below}) {
        side->inverse_slack = 1 / side->slack;
        side->dual = first_dual * side->inverse_slack;
      }
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
      for (Band& band : bands_) {
        for (Band::Side* side : {&band.above, &band.below}) {
          side->slack += alpha_p * side->slack_step;
          side->dual += alpha_d * side->dual_step;
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
    result.coefficients.assign(c_.begin(), c_.begin() + static_cast<std::ptrdiff_t>(n_));
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

  /// low <= w·c <= high; a side that does not bind may be anything far away.
  void add(std::size_t first, const Weights& w, double low, double high) {
    Band band;
    band.first = static_cast<std::uint32_t>(first);
    band.low = low / high;
    for (std::size_t i = 0; i < 3; ++i) band.w[i] = w[i] / high;
    bands_.push_back(band);
  }

  void build_bands() {
    const std::size_t n = p_.intervals();
    bands_.reserve(n * (3 * p_.joint_count + 3));
    places_.reserve(2 * n);
    // Nothing bounds the coefficients from below: the travel time does, which goes to infinity there.
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      const double cap = p_.speed_cap[std::min(j - 1, n - 1)];
      add(j, {1, 0, 0}, -cap, cap);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Basis left = basis(p_, k, false), right = basis(p_, k, true);
      if (k > 0) {
        const double cap = std::min(p_.speed_cap[k], p_.speed_cap[k - 1]);
        if (p_.speed_cap[k] != p_.speed_cap[k - 1]) add(k, left.q, -cap, cap);
        path_acceleration_band(k, left, std::min(p_.rise[k], p_.rise[k - 1]), std::min(p_.fall[k], p_.fall[k - 1]));
        joint_acceleration_bands(k, left, p_.at(k, false), std::min(p_.tightening[k], p_.tightening[k - 1]));
      }
      jerk_bands(k, left, p_.at(k, false), p_.tightening[k]);
      jerk_bands(k, right, p_.at(k, true), p_.tightening[k]);
    }
  }

  void path_acceleration_band(std::size_t k, const Basis& b, double rise, double fall) {
    const double most = std::isfinite(rise) ? rise : fall;
    if (!std::isfinite(most)) return;
    constexpr double kFarAway = 1e3;
    add(k, {b.dq[0] / 2, b.dq[1] / 2, b.dq[2] / 2}, -std::min(fall, kFarAway * most), std::min(rise, kFarAway * most));
  }

  void joint_acceleration_bands(std::size_t k, const Basis& b, const JointDerivatives& d, double tightening) {
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12) continue;
      Weights w;
      for (std::size_t i = 0; i < 3; ++i) w[i] = d.d2[j] * b.q[i] + 0.5 * d.d1[j] * b.dq[i];
      const double most = p_.max_acceleration[j] * tightening;
      add(k, w, -most, most);
    }
  }

  void jerk_bands(std::size_t k, const Basis& b, const JointDerivatives& d, double tightening) {
    const auto place = static_cast<std::uint32_t>(places_.size());
    places_.push_back({static_cast<std::uint32_t>(k), b.q, 0, 0});
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12 && std::abs(d.d3[j]) < 1e-12) continue;
      Band band;
      band.first = static_cast<std::uint32_t>(k);
      band.place = place;
      const double scale = 1 / (p_.max_jerk[j] * tightening);
      for (std::size_t i = 0; i < 3; ++i) {
        band.w[i] = (d.d3[j] * b.q[i] + 1.5 * d.d2[j] * b.dq[i] + 0.5 * d.d1[j] * b.ddq[i]) * scale;
      }
      bands_.push_back(band);
    }
  }

  /// Residuals phi - 1 + slack and low - phi + slack, gradients d phi / d c, and the largest excess over a bound.
  double evaluate(bool first) {
    for (Place& place : places_) {
      place.root = std::sqrt(std::max(dot(place.u, c_.data() + place.first), 1e-30));
      place.half_inverse_root = 0.5 / place.root;
    }
    double infeasible = 0;
    for (Band& band : bands_) {
      const double* const c = c_.data() + band.first;
      double phi = 0;
      if (band.place != kLinear) {
        const Place& place = places_[band.place];
        const double form = dot(band.w, c);
        phi = form * place.root;
        const double half = form * place.half_inverse_root;
        for (std::size_t a = 0; a < 3; ++a) band.gradient[a] = place.root * band.w[a] + half * place.u[a];
      } else {
        // The bounds on single coefficients touch only c[first]; what lies behind it may be beyond the array.
        phi = band.w[1] == 0 && band.w[2] == 0 ? band.w[0] * c[0] : dot(band.w, c);
        band.gradient = band.w;
      }
      const auto settle = [&](Band::Side& side, double excess) {
        infeasible = std::max(infeasible, excess);
        // A side that turned out better than its slack takes it up at once: the linearisation never claims slack that
        // is not there.
        side.slack = std::max(first ? 0.02 : side.slack, -excess);
        side.inverse_slack = 1 / side.slack;
        side.residual = excess + side.slack;
      };
      settle(band.above, phi - 1);
      settle(band.below, band.low - phi);
    }
    return infeasible;
  }

  [[nodiscard]] double travel_time() const {
    double t = 0;
    for (std::size_t k = 0; k < p_.intervals(); ++k) t += p_.step(k) / std::sqrt(std::max(c_[k + 1], 1e-30));
    return t;
  }

  /// Sum of slack times dual, after steps of these lengths.
  [[nodiscard]] double complementarity(double primal, double dual) const {
    double sum = 0;
    for (const Band& band : bands_) {
      const Band::Side &a = band.above, &b = band.below;
      sum += (a.slack + primal * a.slack_step) * (a.dual + dual * a.dual_step);
      sum += (b.slack + primal * b.slack_step) * (b.dual + dual * b.dual_step);
    }
    return sum;
  }

  /// Objective: the sum of h/√c over the middle coefficients, which is the travel time up to second order and convex.
  void assemble() {
    for (auto* v : {&diagonal_, &off1_, &off2_, &objective_gradient_}) std::fill(v->begin(), v->end(), 0.0);
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const double c = c_[k + 1], h = p_.step(k);
      const double force = 0.5 * h / (c * std::sqrt(c));
      objective_gradient_[k + 1] = -force;
      diagonal_[k + 1] += 1.5 * force / c;
    }
    for (const Band& band : bands_) {
      const std::size_t f = band.first;
      const double ratio = band.above.dual * band.above.inverse_slack + band.below.dual * band.below.inverse_slack;
      const Weights& g = band.gradient;
      diagonal_[f] += ratio * g[0] * g[0];
      if (g[1] == 0 && g[2] == 0) continue;
      diagonal_[f + 1] += ratio * g[1] * g[1];
      off1_[f] += ratio * g[0] * g[1];
      if (g[2] == 0) continue;
      diagonal_[f + 2] += ratio * g[2] * g[2];
      off1_[f + 1] += ratio * g[1] * g[2];
      off2_[f] += ratio * g[0] * g[2];
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
    const auto aim = [target](const Band::Side& side) {
      if constexpr (kSecondOrder) return target - side.slack_step * side.dual_step;
      return target;
    };
    for (std::size_t j = 0; j < n_; ++j) rhs_[j] = -objective_gradient_[j];
    for (const Band& band : bands_) {
      const auto pull = [&](const Band::Side& side) {
        return (aim(side) + side.dual * side.residual) * side.inverse_slack;
      };
      const double weight = pull(band.above) - pull(band.below);
      const std::size_t f = band.first;
      const Weights& g = band.gradient;
      rhs_[f] -= weight * g[0];
      if (g[1] != 0) rhs_[f + 1] -= weight * g[1];
      if (g[2] != 0) rhs_[f + 2] -= weight * g[2];
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
    for (Band& band : bands_) {
      const double change = dot(band.gradient, step_.data() + band.first);
      const auto follow = [&](Band::Side& side, double slack_step) {
        side.dual_step = (aim(side) - side.dual * slack_step) * side.inverse_slack - side.dual;
        side.slack_step = slack_step;
      };
      follow(band.above, -band.above.residual - change);
      follow(band.below, -band.below.residual + change);
    }
  }

  struct Reach {
    double primal, dual;
  };
  /// How far the steps may go before a slack or a dual falls to 1 - `fraction` of itself.
  [[nodiscard]] Reach reaches(double fraction) const {
    double fall = fraction;  // largest part of itself that a slack would lose
    double dual = 1;
    for (const Band& band : bands_) {
      fall = std::max(
          {fall, -band.above.slack_step * band.above.inverse_slack, -band.below.slack_step * band.below.inverse_slack});
      for (const Band::Side* side : {&band.above, &band.below}) {
        if (fraction * side->dual < -dual * side->dual_step) dual = -fraction * side->dual / side->dual_step;
      }
    }
    double primal = fraction / fall;
    // q itself must stay positive whatever the slacks say, or the next linearisation has no meaning.
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      if (0.9 * c_[j] < -primal * step_[j]) primal = -0.9 * c_[j] / step_[j];
    }
    return {primal, dual};
  }

  const LawProblem& p_;
  std::size_t n_;
  std::size_t first_free_ = 0, end_free_ = 0;
  std::vector<Place> places_;
  std::vector<Band> bands_;
  std::vector<double> c_, step_, diagonal_, off1_, off2_, rhs_, objective_gradient_;
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess) {
  return Solver(problem, guess).run();
}

}  // namespace rmac
