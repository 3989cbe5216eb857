#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "time_law/law_problem.hpp"

namespace rmac {
namespace {

constexpr int kMaxIterations = 60;
constexpr double kBoundaryFraction = 0.99;
/// Coefficients stay above this part of the first guess: v = 0 inside a window would take for ever.
constexpr double kFloor = 1e-6;
/// Gap of the duality measure at which a law counts as optimal, as a part of the travel time.
constexpr double kGap = 2e-4;
constexpr double kFeasible = 1e-7;

using Weights = std::array<double, 3>;

double dot(const Weights& w, const double* c) noexcept {
  return w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
}

/// Value, slope and curvature of q at one end of interval k as weights of c[k], c[k+1], c[k+2] (eq. 7).
struct Basis {
  Weights q, dq, ddq;
};

Basis basis(const LawProblem& p, std::size_t k, bool right) noexcept {
  const std::size_t n = p.intervals();
  const double h = p.step(k);
  const double before = k > 0 ? p.step(k - 1) : 0;
  const double after = k + 1 < n ? p.step(k + 1) : 0;
  const double a = h / (before + h), b = before / (before + h);  // q at the left node
  const double c = after / (h + after), d = h / (h + after);     // q at the right node
  Basis result{};
  if (right) {
    result.q = {0, c, d};
    result.dq = {0, -2 / (h + after), 2 / (h + after)};
  } else {
    result.q = {a, b, 0};
    result.dq = {-2 / (before + h), 2 / (before + h), 0};
  }
  const double s = 2 / (h * h);
  result.ddq = {a * s, (b + c - 2) * s, d * s};
  return result;
}

/// One inequality phi(c) <= bound on three neighbouring coefficients. Linear: phi = w·c. Jerk: phi = (w·c)·√(u·c),
/// bound 1 (eq. 10).
struct Row {
  std::uint32_t first = 0;
  bool jerk = false;
  double bound = 1;
  Weights w{};
  Weights u{};
};

class Solver {
 public:
  Solver(const LawProblem& problem, const std::vector<double>& guess) : p_(problem), n_(problem.intervals() + 2) {
    fix_ends(guess);
    build_rows();
    slack_.resize(rows_.size());
    dual_.resize(rows_.size());
    residual_.resize(rows_.size());
    gradient_.resize(rows_.size());
    slack_step_.resize(rows_.size());
    dual_step_.resize(rows_.size());
    for (auto* v : {&diagonal_, &off1_, &off2_, &rhs_}) v->resize(n_);
    step_.assign(n_ + 2, 0.0);
  }

  LawSolution run() {
    LawSolution result;
    evaluate_rows();
    double scale = travel_time();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      slack_[i] = std::max(-residual_[i], 0.02);
      dual_[i] = scale / static_cast<double>(rows_.size()) * 0.1 / slack_[i];
      residual_[i] += slack_[i];
    }
    for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
      result.iterations = iteration + 1;
      const double mu = complementarity();
      assemble();
      if (!factorise()) break;
      // Predictor: how far a pure Newton step gets tells how much to centre (Mehrotra).
      direction(0, false);
      const double reach_p = primal_reach(1), reach_d = dual_reach(1);
      double mu_affine = 0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        mu_affine += (slack_[i] + reach_p * slack_step_[i]) * (dual_[i] + reach_d * dual_step_[i]);
      }
      mu_affine /= static_cast<double>(rows_.size());
      const double ratio = mu_affine / mu;
      const double sigma = std::clamp(ratio * ratio * ratio, 1e-4, 0.8);
      direction(sigma * mu, true);
      const double alpha_p = primal_reach(kBoundaryFraction), alpha_d = dual_reach(kBoundaryFraction);
      for (std::size_t j = 0; j < n_; ++j) c_[j] += alpha_p * step_[j];
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        slack_[i] += alpha_p * slack_step_[i];
        dual_[i] += alpha_d * dual_step_[i];
      }
      evaluate_rows();
      double infeasible = 0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        // A row that turned out better than its slack takes it up at once: the linearisation never claims slack that is
        // not there.
        slack_[i] = std::max(slack_[i], -residual_[i]);
        infeasible = std::max(infeasible, residual_[i]);
        residual_[i] += slack_[i];
      }
      scale = travel_time();
      if (infeasible <= kFeasible && complementarity() * static_cast<double>(rows_.size()) <= kGap * scale) {
        result.converged = true;
        break;
      }
      if (alpha_p < 1e-9) break;
    }
    if (!result.converged) {
      double worst = 0;
      evaluate_rows();
      for (const double r : residual_) worst = std::max(worst, r);
      result.converged = worst <= 1e-5;  // feasible, if not proven optimal
    }
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
      initial_guess();
      for (std::size_t i = 0; i < p_.travelled_before.size(); ++i) c_[i] = std::max(c_[i], p_.travelled_before[i]);
    }
    c_[0] = p_.begin.v * p_.begin.v;
    c_[1] = c_[0] + p_.begin.a * p_.step(0);
    c_[n_ - 1] = p_.end.v * p_.end.v;
    c_[n_ - 2] = c_[n_ - 1] - p_.end.a * p_.step(last);
    first_free_ = 2;
    end_free_ = n_ - 2;
  }

  /// A profile not far from what the bounds allow: at each place no faster than curvature and its change would permit
  /// at constant speed, and from place to place growing no faster than a part of the acceleration permits; then
  /// smoothed, because a kink is jerk.
  void initial_guess() {
    const std::size_t n = p_.intervals();
    std::vector<double> node(n + 1), slope(n);
    const auto permitted = [&](const JointDerivatives& d) {
      double q = std::numeric_limits<double>::infinity();
      for (std::size_t j = 0; j < p_.joint_count; ++j) {
        if (d.d2[j] != 0) q = std::min(q, 0.4 * p_.max_acceleration[j] / std::abs(d.d2[j]));
        if (d.d3[j] != 0) q = std::min(q, std::pow(0.2 * p_.max_jerk[j] / std::abs(d.d3[j]), 2.0 / 3));
      }
      return q;
    };
    for (double& q : node) q = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < n; ++k) {
      const JointDerivatives left = p_.at(k, false), right = p_.at(k, true);
      node[k] = std::min({node[k], 0.7 * p_.speed_cap[k], permitted(left)});
      node[k + 1] = std::min({node[k + 1], 0.7 * p_.speed_cap[k], permitted(right)});
      double limit = std::min(p_.rise[k], p_.fall[k]);
      for (std::size_t j = 0; j < p_.joint_count; ++j) {
        if (std::abs(left.d1[j]) > 1e-9) limit = std::min(limit, p_.max_acceleration[j] / std::abs(left.d1[j]));
      }
      slope[k] = 0.5 * limit;
    }
    const double first = p_.begin.v * p_.begin.v, last = p_.end.v * p_.end.v;
    node[0] = first;
    for (std::size_t k = 0; k < n; ++k) node[k + 1] = std::min(node[k + 1], node[k] + slope[k] * p_.step(k));
    node[n] = last;
    for (std::size_t k = n; k-- > 0;) node[k] = std::min(node[k], node[k + 1] + slope[k] * p_.step(k));
    node[0] = first;
    for (int pass = 0; pass < 4; ++pass) {
      double before = node[0];
      for (std::size_t k = 1; k < n; ++k) {
        const double here = node[k];
        node[k] = std::min(here, 0.25 * before + 0.5 * here + 0.25 * node[k + 1]);
        before = here;
      }
    }
    for (std::size_t k = 0; k < n; ++k) c_[k + 1] = 0.5 * (node[k] + node[k + 1]);
  }

  void add(std::size_t first, const Weights& w, double bound) {
    Row row;
    row.first = static_cast<std::uint32_t>(first);
    row.bound = 1;
    for (std::size_t i = 0; i < 3; ++i) row.w[i] = w[i] / bound;
    rows_.push_back(row);
  }

  void add_both(std::size_t first, const Weights& w, double bound) {
    add(first, w, bound);
    add(first, {-w[0], -w[1], -w[2]}, bound);
  }

  void build_rows() {
    const std::size_t n = p_.intervals();
    rows_.reserve(n * (6 * p_.joint_count + 6));
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      const std::size_t k = std::min(j - 1, n - 1);
      add(j, {1, 0, 0}, p_.speed_cap[k]);
      Row floor;  // c >= floor
      floor.first = static_cast<std::uint32_t>(j);
      floor.w = {-1 / c_[j], 0, 0};
      floor.bound = -kFloor;
      rows_.push_back(floor);
    }
    for (std::size_t k = 0; k < n; ++k) {
      const Basis left = basis(p_, k, false), right = basis(p_, k, true);
      if (k > 0) {
        if (p_.speed_cap[k] != p_.speed_cap[k - 1]) add(k, left.q, std::min(p_.speed_cap[k], p_.speed_cap[k - 1]));
        path_acceleration_rows(k, left, std::min(p_.rise[k], p_.rise[k - 1]), std::min(p_.fall[k], p_.fall[k - 1]));
        joint_acceleration_rows(k, left, p_.at(k, false), std::min(p_.tightening[k], p_.tightening[k - 1]));
      }
      jerk_rows(k, left, p_.at(k, false), p_.tightening[k]);
      jerk_rows(k, right, p_.at(k, true), p_.tightening[k]);
    }
  }

  void path_acceleration_rows(std::size_t k, const Basis& b, double rise, double fall) {
    if (std::isfinite(rise)) add(k, {b.dq[0] / 2, b.dq[1] / 2, b.dq[2] / 2}, rise);
    if (std::isfinite(fall)) add(k, {-b.dq[0] / 2, -b.dq[1] / 2, -b.dq[2] / 2}, fall);
  }

  void joint_acceleration_rows(std::size_t k, const Basis& b, const JointDerivatives& d, double tightening) {
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12) continue;
      Weights w;
      for (std::size_t i = 0; i < 3; ++i) w[i] = d.d2[j] * b.q[i] + 0.5 * d.d1[j] * b.dq[i];
      add_both(k, w, p_.max_acceleration[j] * tightening);
    }
  }

  void jerk_rows(std::size_t k, const Basis& b, const JointDerivatives& d, double tightening) {
    for (std::size_t j = 0; j < p_.joint_count; ++j) {
      if (std::abs(d.d1[j]) < 1e-12 && std::abs(d.d2[j]) < 1e-12 && std::abs(d.d3[j]) < 1e-12) continue;
      Row row;
      row.first = static_cast<std::uint32_t>(k);
      row.jerk = true;
      row.u = b.q;
      const double scale = 1 / (p_.max_jerk[j] * tightening);
      for (std::size_t i = 0; i < 3; ++i) {
        row.w[i] = (d.d3[j] * b.q[i] + 1.5 * d.d2[j] * b.dq[i] + 0.5 * d.d1[j] * b.ddq[i]) * scale;
      }
      rows_.push_back(row);
      for (double& w : row.w) w = -w;
      rows_.push_back(row);
    }
  }

  /// residual = phi - bound, gradient = d phi / d c.
  void evaluate_rows() {
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Row& row = rows_[i];
      const double* const c = c_.data() + row.first;
      if (!row.jerk) {
        // The bounds on single coefficients touch only c[first]; what lies behind it may be beyond the array.
        const double value = row.w[1] == 0 && row.w[2] == 0 ? row.w[0] * c[0] : dot(row.w, c);
        residual_[i] = value - row.bound;
        gradient_[i] = row.w;
        continue;
      }
      const double form = dot(row.w, c);
      const double q = std::max(dot(row.u, c), 1e-30);
      const double root = std::sqrt(q);
      residual_[i] = form * root - row.bound;
      const double half = 0.5 * form / root;
      for (std::size_t a = 0; a < 3; ++a) gradient_[i][a] = root * row.w[a] + half * row.u[a];
    }
  }

  [[nodiscard]] double travel_time() const {
    double t = 0;
    for (std::size_t k = 0; k < p_.intervals(); ++k) t += p_.step(k) / std::sqrt(std::max(c_[k + 1], 1e-30));
    return t;
  }

  [[nodiscard]] double complementarity() const {
    double sum = 0;
    for (std::size_t i = 0; i < rows_.size(); ++i) sum += slack_[i] * dual_[i];
    return sum / static_cast<double>(rows_.size());
  }

  /// Objective: the sum of h/√c over the middle coefficients, which is the travel time up to second order and convex.
  void assemble() {
    std::fill(diagonal_.begin(), diagonal_.end(), 0.0);
    std::fill(off1_.begin(), off1_.end(), 0.0);
    std::fill(off2_.begin(), off2_.end(), 0.0);
    objective_gradient_.assign(n_, 0.0);
    for (std::size_t k = 0; k < p_.intervals(); ++k) {
      const double c = c_[k + 1], h = p_.step(k);
      const double root = std::sqrt(c);
      objective_gradient_[k + 1] = -0.5 * h / (c * root);
      diagonal_[k + 1] += 0.75 * h / (c * c * root);
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const std::size_t f = rows_[i].first;
      const double ratio = dual_[i] / slack_[i];
      const Weights& g = gradient_[i];
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

  /// LDLᵀ of the pentadiagonal matrix over the free coefficients, in place.
  bool factorise() {
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      double d = diagonal_[j];
      double l1 = off1_[j], l2 = off2_[j];
      if (j >= first_free_ + 1) {
        d -= off1_[j - 1] * off1_[j - 1] * diagonal_[j - 1];
        l1 -= off1_[j - 1] * off2_[j - 1] * diagonal_[j - 1];
      }
      if (j >= first_free_ + 2) d -= off2_[j - 2] * off2_[j - 2] * diagonal_[j - 2];
      if (!(d > 0) || !std::isfinite(d)) return false;
      diagonal_[j] = d;
      off1_[j] = j + 1 < end_free_ ? l1 / d : 0;
      off2_[j] = j + 2 < end_free_ ? l2 / d : 0;
    }
    return true;
  }

  void direction(double target, bool second_order) {
    for (std::size_t j = 0; j < n_; ++j) rhs_[j] = -objective_gradient_[j];
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const double correction = second_order ? slack_step_[i] * dual_step_[i] : 0;
      const double weight = (target - correction + dual_[i] * residual_[i]) / slack_[i];
      const std::size_t f = rows_[i].first;
      const Weights& g = gradient_[i];
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
    for (std::size_t j = first_free_; j < end_free_; ++j) step_[j] /= diagonal_[j];
    for (std::size_t j = end_free_; j-- > first_free_;) {
      if (j + 1 < end_free_) step_[j] -= off1_[j] * step_[j + 1];
      if (j + 2 < end_free_) step_[j] -= off2_[j] * step_[j + 2];
    }
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Weights& g = gradient_[i];
      const double* const s = step_.data() + rows_[i].first;
      const double change = g[0] * s[0] + (g[1] != 0 ? g[1] * s[1] : 0) + (g[2] != 0 ? g[2] * s[2] : 0);
      const double correction = second_order ? slack_step_[i] * dual_step_[i] : 0;
      const double slack_step = -residual_[i] - change;
      dual_step_[i] = (target - correction - dual_[i] * slack_step) / slack_[i] - dual_[i];
      slack_step_[i] = slack_step;
    }
  }

  [[nodiscard]] double primal_reach(double fraction) const {
    double reach = 1;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (slack_step_[i] < 0) reach = std::min(reach, -fraction * slack_[i] / slack_step_[i]);
    }
    // q itself must stay positive whatever the slacks say, or the next linearisation has no meaning.
    for (std::size_t j = first_free_; j < end_free_; ++j) {
      if (step_[j] < 0) reach = std::min(reach, -0.9 * c_[j] / step_[j]);
    }
    return reach;
  }

  [[nodiscard]] double dual_reach(double fraction) const {
    double reach = 1;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      if (dual_step_[i] < 0) reach = std::min(reach, -fraction * dual_[i] / dual_step_[i]);
    }
    return reach;
  }

  const LawProblem& p_;
  std::size_t n_;
  std::size_t first_free_ = 0, end_free_ = 0;
  std::vector<Row> rows_;
  std::vector<double> c_, slack_, dual_, residual_, slack_step_, dual_step_, step_;
  std::vector<Weights> gradient_;
  std::vector<double> diagonal_, off1_, off2_, rhs_, objective_gradient_;
};

}  // namespace

LawSolution solve_law(const LawProblem& problem, const std::vector<double>& guess) {
  return Solver(problem, guess).run();
}

SplineStart spline_start(const LawProblem& p, const std::vector<double>& c, std::size_t k) noexcept {
  const Basis b = basis(p, k, false);
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
