#include "tubes/draft_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "curves/vector.hpp"
#include "time_law/law_spline.hpp"
#include "time_law/speed_bound.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::dot;
using quintic::kDegree;

constexpr int kIntervalsASpan = 2;
/// How much of the mean price is asked for staying near: prices hold for the spline that they were found on.
constexpr double kStay = 30;
/// Where jerk binds changes from one law to the next: what counts is the mean of the laws so far, the last for most.
constexpr double kLastLaw = 0.5;

}  // namespace

std::optional<std::vector<LineLimits>> line_limits(const PathSegments& lines) {
  std::vector<LineLimits> all;
  for (const auto& line : lines) {
    const PathDemand& demand = line->demand();
    LineLimits& limits = all.emplace_back();
    limits.rates.resize(line->joint_count());
    limits.feed_mm_s = demand.feed_mm_s;
    limits.rise_mm_s2 = or_unbounded(demand.accel_rise_mm_s2);
    limits.fall_mm_s2 = or_unbounded(demand.accel_fall_mm_s2);
    CurvePoint tip;
    line->curve().evaluate(0, 1, 1, tip);
    for (std::size_t c = 0; c < 3; ++c) {
      tip.d[1] = {};
      tip.d[1][c] = 1;
      JointPoint joints;
      if (line->map()->evaluate(tip, line->curve().dimension(), 1, line->joints_at_node(0), joints) !=
          KinematicsStatus::Ok)
        return std::nullopt;
      for (std::size_t j = 0; j < limits.rates.size(); ++j) limits.rates[j][c] = joints.d[1][j];
    }
  }
  return all;
}

DraftLaw::DraftLaw(const std::vector<double>& knots, const Polyline& polyline, std::vector<LineLimits> lines,
                   const std::vector<JointLimits>& joints)
    : joints_(joints), lines_(std::move(lines)) {
  const std::size_t count = knots.size() - kDegree - 1;
  problem_.draft = true;
  problem_.joint_count = joints_.size();
  for (const JointLimits& joint : joints_) {
    problem_.max_acceleration.push_back(joint.max_acceleration);
    problem_.max_jerk.push_back(joint.max_jerk);
  }
  std::size_t line = 0;
  for (std::size_t i = kDegree; i <= count; ++i) {
    const int parts = i < count ? kIntervalsASpan : 1;
    for (int part = 0; part < parts; ++part) {
      const double place = knots[i] + (i < count ? knots[i + 1] - knots[i] : 0) * part / kIntervalsASpan;
      while (line + 1 < polyline.lines() && polyline.places[line + 1] <= place) ++line;
      problem_.nodes.push_back(place);
      Node& node = nodes_.emplace_back();
      node.line = line;
      for (std::size_t order = 1; order <= 3; ++order)
        node.derivatives[order - 1] = quintic::derivatives(knots, count, place, order);
    }
  }
  const std::size_t intervals = problem_.intervals();
  problem_.tightening.assign(intervals, 1.0);
  problem_.speed_cap.resize(intervals);
  problem_.derivatives.resize(intervals * 6 * problem_.joint_count);
  for (std::size_t k = 0; k < intervals; ++k) {
    problem_.rise.push_back(lines_[nodes_[k].line].rise_mm_s2);
    problem_.fall.push_back(lines_[nodes_[k].line].fall_mm_s2);
  }
}

double DraftLaw::solve(const std::vector<Vector>& points) {
  double* value = problem_.derivatives.data();
  for (std::size_t k = 0; k < problem_.intervals(); ++k) {
    const LineLimits& line = lines_[nodes_[k].line];
    double& cap = problem_.speed_cap[k];
    cap = std::numeric_limits<double>::infinity();
    for (const std::size_t end : {k, k + 1}) {
      for (const quintic::Basis& derivative : nodes_[end].derivatives) {
        const Vector d = quintic::value(derivative, points);
        for (const Vector& rate : line.rates) *value++ = dot(rate, d);
      }
      const Vector tangent = quintic::value(nodes_[end].derivatives[0], points);
      cap = std::min(cap, line.feed_mm_s * line.feed_mm_s / dot(tangent, tangent));
      for (std::size_t j = 0; j < joints_.size(); ++j) {
        const double rate = dot(line.rates[j], tangent), speed = joints_[j].max_speed;
        if (rate != 0) cap = std::min(cap, speed * speed / (rate * rate));
      }
    }
  }
  law_ = solve_law(problem_, law_.coefficients);
  double time = 0;
  for (std::size_t k = 0; k < problem_.intervals(); ++k) time += problem_.step(k) / std::sqrt(law_.coefficients[k + 1]);
  if (law_.converged && std::isfinite(time)) return time;
  law_.coefficients.clear();
  return std::numeric_limits<double>::infinity();
}

std::vector<SplineDemand> DraftLaw::demands(const std::vector<Vector>& points) {
  const std::size_t joint_count = problem_.joint_count, intervals = problem_.intervals();
  if (prices_.empty()) prices_ = law_.jerk_prices;
  double mean = 0;
  for (std::size_t i = 0; i < prices_.size(); ++i) {
    prices_[i] += kLastLaw * (law_.jerk_prices[i] - prices_[i]);
    mean += prices_[i];
  }
  mean /= (problem_.nodes.back() - problem_.nodes.front()) * static_cast<double>(joint_count);
  std::vector<SplineDemand> demands;
  for (std::size_t k = 0; k < intervals; ++k) {
    const double stay = kStay * mean * problem_.step(k) / 2;
    for (const bool right : {false, true}) {
      const Node& node = nodes_[right ? k + 1 : k];
      const LawBasis law = basis(problem_, k, right);
      const double* const q_spline = law_.coefficients.data() + k;
      const double q = dot(law.q, q_spline), v = std::sqrt(std::max(q, 0.0));
      const Vector share{0.5 * dot(law.ddq, q_spline) * v, 1.5 * dot(law.dq, q_spline) * v, q * v};
      SplineDemand demand;
      demand.basis.first = node.derivatives[0].first;
      for (std::size_t a = 0; a <= kDegree; ++a) {
        for (std::size_t order = 0; order < 3; ++order)
          demand.basis.values[a] += share[order] * node.derivatives[order].values[a];
      }
      const Vector here = quintic::value(demand.basis, points);
      for (std::size_t j = 0; j < joint_count; ++j) {
        const Vector rate = curves::scaled(1 / joints_[j].max_jerk, lines_[nodes_[k].line].rates[j]);
        const double price = prices_[(2 * k + (right ? 1U : 0U)) * joint_count + j], jerk = dot(rate, here);
        for (std::size_t c = 0; c < 3; ++c) demand.weight[c] = along(demand.weight[c], (price + stay) * rate[c], rate);
        demand.pull = along(demand.pull, stay * jerk, rate);
        demand.constant += 0.5 * stay * jerk * jerk;
      }
      demands.push_back(demand);
    }
  }
  return demands;
}

}  // namespace rmac
