#include "short_lines/turning_curve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "curves/vector.hpp"
#include "splines/quintic.hpp"

namespace rmac {

using quintic::kDegree;

namespace {
constexpr double kDense_mm = 0.5;
}  // namespace

std::vector<std::size_t> rotary_joints(const Kinematics& kinematics) {
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < kinematics.joint_count(); ++j) {
    if (kinematics.joint_type(j) == JointType::Rotary) joints.push_back(j);
  }
  return joints;
}

Vector axis_of_turns(const PoseToJoints& map, const double* turns) noexcept {
  std::array<double, kMaxJoints> joints{};
  std::size_t turn = 0;
  for (std::size_t j = 0; j < map.joint_count(); ++j) {
    if (map.kinematics().joint_type(j) == JointType::Rotary) joints[j] = turns[turn++];
  }
  return map.pose({joints.data(), map.joint_count()}).axis;
}

TurnTable::TurnTable(const LineSpline& spline, std::size_t joint_count) : joint_count_(joint_count) {
  const std::size_t count = spline.points.size();
  double factorial = 1;
  for (std::size_t i = kDegree; i < count; ++i) {
    const double begin = spline.knots[i];
    knots_.push_back(begin);
    Powers& powers = powers_.emplace_back();
    powers[0] = quintic::value(quintic::basis(spline.knots, count, begin), spline.points);
    factorial = 1;
    for (std::size_t k = 1; k <= kDegree; ++k) {
      factorial *= static_cast<double>(k);
      powers[k] = curves::scaled(1 / factorial,
                                 quintic::value(quintic::derivatives(spline.knots, count, begin, k), spline.points));
    }
  }
  knots_.push_back(spline.knots[count]);
}

void TurnTable::evaluate(double s, int order, CurvePoint& point) const noexcept {
  const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, s);
  const auto span = static_cast<std::size_t>(above - knots_.begin()) - 1;
  const double u = s - knots_[span];
  const Powers& p = powers_[span];
  for (std::size_t i = 0; i < joint_count_; ++i) {
    const double a = p[0][i], b = p[1][i], c = p[2][i], d = p[3][i], e = p[4][i], f = p[5][i];
    point.d[0][6 + i] = a + u * (b + u * (c + u * (d + u * (e + u * f))));
    if (order >= 1) point.d[1][6 + i] = b + u * (2 * c + u * (3 * d + u * (4 * e + u * 5 * f)));
    if (order >= 2) point.d[2][6 + i] = 2 * c + u * (6 * d + u * (12 * e + u * 20 * f));
    if (order >= 3) point.d[3][6 + i] = 6 * d + u * (24 * e + u * 60 * f);
  }
}

TurningCurve::TurningCurve(std::shared_ptr<const Curve> tip, std::shared_ptr<const TurnTable> turns, double offset,
                           std::shared_ptr<const PoseToJoints> map)
    : tip_(std::move(tip)), turns_(std::move(turns)), offset_(offset), map_(std::move(map)) {
  // The turns' knots are as dense as they bend, and twice as many nodes as knots tell a law how, where they are dense:
  // between two nodes of the tip as many more, evenly.
  const auto own = tip_->nodes();
  const std::vector<double>& knots = turns_->knots();
  nodes_.push_back(own[0]);
  for (std::size_t i = 0; i + 1 < own.size(); ++i) {
    auto knot = std::upper_bound(knots.begin(), knots.end(), offset_ + own[i]);
    double step = own[i + 1] - own[i];
    for (; knot != knots.begin() && knot != knots.end(); ++knot) {
      const double span = *knot - *(knot - 1);
      step = std::min(step, span < kDense_mm ? span / 2 : span);
      if (*knot >= offset_ + own[i + 1]) break;
    }
    const double parts = std::ceil((own[i + 1] - own[i]) / step - 1e-6);
    for (double k = 1; k <= parts; ++k) nodes_.push_back(own[i] + (own[i + 1] - own[i]) * k / parts);
    nodes_.back() = own[i + 1];
  }
}

void TurningCurve::evaluate(double s, int order, int side, CurvePoint& point) const noexcept {
  tip_->evaluate(s, order, side, point);
  turns_->evaluate(offset_ + s, order, point);
  const Vector axis = axis_of_turns(*map_, point.d[0].data() + 6);
  std::copy(axis.begin(), axis.end(), point.d[0].begin() + 3);
}

}  // namespace rmac
