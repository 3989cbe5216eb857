#include <algorithm>
#include <numbers>

#include "axis_turn.hpp"
#include "vector.hpp"

namespace rmac::curves {
namespace {

constexpr double kInDegrees = 180 / std::numbers::pi;

/// Tip on a line, axis on a great circle. Where the tip rests, s is the turn in degrees, and what little the tip moves
/// goes in step with it.
class LineCurve final : public Curve {
 public:
  LineCurve(const Vector& start, const Vector& end, double length, const AxisTurn& turn)
      : start_(start), step_(scaled(1 / length, difference(end, start))), ends_{0, length}, turn_(turn) {
    if (turn.angle_rad() > kNodeTurn_rad) nodes_ = even_nodes(length, turn.angle_rad());
  }

  [[nodiscard]] bool in_joint_space() const noexcept override { return false; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return 6; }
  [[nodiscard]] double length() const noexcept override { return ends_[1]; }
  [[nodiscard]] bool straight() const noexcept override { return turn_.angle_rad() == 0; }
  [[nodiscard]] bool even() const noexcept override { return dot(step_, step_) > 0.5; }
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return {}; }
  [[nodiscard]] std::span<const double> nodes() const noexcept override {
    if (nodes_.empty()) return ends_;
    return nodes_;
  }

  void evaluate(double s, int order, int /*side*/, CurvePoint& point) const noexcept override {
    s = std::clamp(s, 0.0, ends_[1]);
    for (std::size_t c = 0; c < 3; ++c) {
      point.d[0][c] = start_[c] + s * step_[c];
      if (order >= 1) point.d[1][c] = step_[c];
      if (order >= 2) point.d[2][c] = 0;
      if (order >= 3) point.d[3][c] = 0;
    }
    turn_.evaluate(s, ends_[1], order, point);
  }

 private:
  Vector start_;
  Vector step_;  ///< tip per unit of s
  std::array<double, 2> ends_;
  AxisTurn turn_;
  std::vector<double> nodes_;  ///< empty where the two ends are enough
};

class JointLineCurve final : public Curve {
 public:
  JointLineCurve(std::span<const double> start, std::span<const double> end, double length)
      : start_(start.begin(), start.end()), step_(start.size()), ends_{0, length} {
    for (std::size_t j = 0; j < start.size(); ++j) step_[j] = (end[j] - start[j]) / length;
  }

  [[nodiscard]] bool in_joint_space() const noexcept override { return true; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return start_.size(); }
  [[nodiscard]] double length() const noexcept override { return ends_[1]; }
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return {}; }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return ends_; }

  void evaluate(double s, int order, int /*side*/, CurvePoint& point) const noexcept override {
    s = std::clamp(s, 0.0, ends_[1]);
    for (std::size_t j = 0; j < start_.size(); ++j) {
      point.d[0][j] = start_[j] + s * step_[j];
      if (order >= 1) point.d[1][j] = step_[j];
      if (order >= 2) point.d[2][j] = 0;
      if (order >= 3) point.d[3][j] = 0;
    }
  }

 private:
  std::vector<double> start_;
  std::vector<double> step_;
  std::array<double, 2> ends_;
};

}  // namespace

Expected<CurvePtr> make_line(const ToolPose& start, const ToolPose& end) {
  const auto turn = AxisTurn::between(start.axis, end.axis);
  if (!turn) return tl::unexpected(turn.error());
  const double tip_mm = distance(start.tip, end.tip);
  const bool turns = turn->angle_rad() > kStartTolerance_axis;
  if (turns && tip_mm < kStartTolerance_mm) {
    return std::make_unique<LineCurve>(start.tip, end.tip, turn->angle_rad() * kInDegrees, *turn);
  }
  if (tip_mm <= kZeroLength_mm) return CurvePtr{};
  return std::make_unique<LineCurve>(start.tip, end.tip, tip_mm, *turn);
}

Expected<CurvePtr> make_joint_line(std::span<const double> start, std::span<const double> end) {
  if (start.size() != end.size()) {
    return refuse("the joint target has " + std::to_string(end.size()) + " values, the machine has " +
                  std::to_string(start.size()) + " joints");
  }
  double sum = 0;
  for (std::size_t j = 0; j < end.size(); ++j) {
    if (!std::isfinite(end[j])) return refuse("the target of joint " + std::to_string(j) + " is not a finite number");
    sum += (end[j] - start[j]) * (end[j] - start[j]);
  }
  const double length = std::sqrt(sum);
  if (!std::isfinite(length)) return refuse("the joint target is too far away to be a number");
  if (length <= kZeroLength_mm) return CurvePtr{};
  return std::make_unique<JointLineCurve>(start, end, length);
}

}  // namespace rmac::curves
