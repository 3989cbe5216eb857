#pragma once

#include <memory>
#include <vector>

#include "rmac/motion/curve.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/path_segment.hpp"

namespace rmac {

/// Closer to the pole than this a path's own tool axis is not followed, in rad: 0.1 degrees.
inline constexpr double kPoleCap = 0.1 * 0.017453292519943295;
/// By no more than this the tool axis leaves the programmed one there, in rad; the tip does not leave its path.
inline constexpr double kPoleDeviation = 2 * kPoleCap;

/// Where a curve's tool axis comes within `kPoleCap` of the pole, and the nodes that the rest of it needs so that no
/// joint turns far between two of them (docs/derivations/pole.md).
struct PoleMap {
  struct Stretch {
    double begin = 0, end = 0;
  };
  std::vector<Stretch> passages;
  std::vector<double> nodes;
};

/// `pole` is its direction in the part frame. Nothing where the axis does not turn.
[[nodiscard]] PoleMap map_pole(const Curve& curve, const Vector& pole);

/// What a rotary joint does at one end of a passage: its position and three derivatives by path length.
using TurnState = std::array<double, 4>;

/// One rotary joint along a passage, from its state at the begin to that at the end: the polynomial of degree 7.
class TurnWay {
 public:
  TurnWay(const TurnState& begin, const TurnState& end, double length) noexcept;
  /// Derivative of an order, 0 to 3, at s.
  [[nodiscard]] double at(double s, std::size_t order) const noexcept;

 private:
  std::array<double, 8> coefficient_{};  ///< of powers of s / length
  double length_;
};

/// A stretch of a curve in pose space on which the rotary joints are told, and the tool axis with them.
class PolePassage final : public Curve {
 public:
  PolePassage(std::shared_ptr<const Curve> stretch, std::vector<TurnWay> turns,
              std::shared_ptr<const PoseToJoints> map);

  [[nodiscard]] bool in_joint_space() const noexcept override { return false; }
  [[nodiscard]] std::size_t dimension() const noexcept override { return 6 + turns_.size(); }
  [[nodiscard]] double length() const noexcept override { return stretch_->length(); }
  [[nodiscard]] bool even() const noexcept override { return stretch_->even(); }
  [[nodiscard]] const Curve& programmed() const noexcept override { return *stretch_; }
  /// The derivatives of i j k stay the programmed ones'.
  void evaluate(double s, int order, int side, CurvePoint& point) const noexcept override;
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return stretch_->breaks(); }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return nodes_; }

  /// The largest angle between the tool axis and the programmed one, in rad, and where it is.
  [[nodiscard]] std::pair<double, double> largest_deviation() const;

 private:
  std::shared_ptr<const Curve> stretch_;
  std::vector<TurnWay> turns_;
  std::shared_ptr<const PoseToJoints> map_;
  std::vector<double> nodes_;
};

/// Where a path stands as it comes to a stretch near the pole.
struct PoleEntry {
  std::vector<double> joints;
  const PathSegment* before = nullptr;  ///< the piece of the same curve that ends there; none at the curve's begin
  /// By so much, in rad, lines may leave the programmed axis where they are smoothed (`short_lines`); 0: they are not.
  double tolerance_rad = 0;
};

/// The passages that can lead past the pole from `entry`, the quickest for the rotary joints first: to each solution at
/// the stretch's end, within the joints' travel where there is one. Of lines that will be smoothed, the one that comes
/// nearest to the pole leads straight over it where the tolerance lets it, and otherwise as its axis goes. `next` is
/// the rest of the curve up to the next passage, or none where the curve ends with this one.
[[nodiscard]] std::vector<std::shared_ptr<const PolePassage>> pole_passages(
    const std::shared_ptr<const Curve>& stretch, const PoleEntry& entry, const std::shared_ptr<const Curve>& next,
    const std::shared_ptr<const PoseToJoints>& map, const std::vector<JointLimits>& joints);

}  // namespace rmac
