#pragma once

#include <array>
#include <memory>
#include <vector>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/pose_to_joints.hpp"
#include "splines/line_spline.hpp"

namespace rmac {

/// The rotary joints of a quintic spline by path length, span by span as powers. Real-time safe.
class TurnTable {
 public:
  TurnTable(const LineSpline& spline, std::size_t joint_count);

  [[nodiscard]] std::size_t joint_count() const noexcept { return joint_count_; }
  [[nodiscard]] const std::vector<double>& knots() const noexcept { return knots_; }
  /// Derivatives up to `order` (0 to 3) at s into coordinates 6 on.
  void evaluate(double s, int order, CurvePoint& point) const noexcept;

 private:
  using Powers = std::array<Vector, 6>;
  std::size_t joint_count_;
  std::vector<double> knots_;   ///< distinct, ascending
  std::vector<Powers> powers_;  ///< of each span, by the distance from its begin
};

/// A tip's path on which the rotary joints are told, and the tool axis with them: a run of lines on which it turned
/// (docs/derivations/joins.md, section 8). Has no derivatives of i j k.
class TurningCurve final : public Curve {
 public:
  /// `turns` begins `offset` before the tip's path does.
  TurningCurve(std::shared_ptr<const Curve> tip, std::shared_ptr<const TurnTable> turns, double offset,
               std::shared_ptr<const PoseToJoints> map);

  [[nodiscard]] bool in_joint_space() const noexcept override { return false; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return 6 + turns_->joint_count(); }
  [[nodiscard]] double length() const noexcept override { return tip_->length(); }
  void evaluate(double s, int order, int side, CurvePoint& point) const noexcept override;
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return tip_->breaks(); }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return nodes_; }

 private:
  std::shared_ptr<const Curve> tip_;
  std::shared_ptr<const TurnTable> turns_;
  double offset_;
  std::shared_ptr<const PoseToJoints> map_;
  std::vector<double> nodes_;
};

/// The rotary joints among all, in their order.
[[nodiscard]] std::vector<std::size_t> rotary_joints(const Kinematics& kinematics);
/// The tool axis, in the part frame, that rotary joints give: slides carry it along as it is.
[[nodiscard]] Vector axis_of_turns(const PoseToJoints& map, const double* turns) noexcept;

}  // namespace rmac
