#include "path/joint_nodes.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// How far the joints may be from that cubic half way between places, mm or degrees.
constexpr double kKnown = 1e-4;
/// Places nearer to each other than this, in mm, tell nothing more; joints that are still further than this from where
/// they are expected jump.
constexpr double kNearest_mm = 1e-5, kJump = 1e-2;
/// Many more than any geometry needs: what goes on beyond is noise.
constexpr std::size_t kMostAdded = 20'000;

class Nodes {
 public:
  Nodes(const Curve& curve, const PoseToJoints& map) : curve_(curve), map_(map), n_(map.joint_count()) {}

  JointNodes find(std::span<const double> start_joints) {
    const auto own = curve_.nodes();
    result_.joints.reserve(own.size() * n_);
    JointPoint point;
    if (fails(own[0], own[0] > 0 ? -1 : 1, start_joints, point)) return std::move(result_);
    keep(own[0], point);
    for (std::size_t i = 1; i < own.size(); ++i) {
      // At a break the derivatives ahead are others.
      if (!curve_.breaks().empty() && fails(own[i - 1], 1, last_joints(), point)) break;
      if (!reach(own[i - 1], point, own[i])) break;
    }
    if (places_.size() > own.size()) result_.places = std::move(places_);
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::span<const double> last_joints() const { return std::span(result_.joints).last(n_); }

  KinematicsStatus evaluate(double s, int side, std::span<const double> seed, JointPoint& point) const {
    CurvePoint c;
    curve_.evaluate(s, 1, side, c);
    if (!curve_.in_joint_space()) return map_.evaluate(c, curve_.dimension(), 1, seed, point);
    for (std::size_t k = 0; k < 2; ++k) std::copy_n(c.d[k].begin(), n_, point.d[k].begin());
    return KinematicsStatus::Ok;
  }

  bool fails(double s, int side, std::span<const double> seed, JointPoint& point) {
    return refuse(evaluate(s, side, seed, point), s);
  }
  bool refuse(KinematicsStatus status, double s) {
    result_.status = status;
    result_.s_failed = s;
    return status != KinematicsStatus::Ok;
  }
  void keep(double s, const JointPoint& point) {
    places_.push_back(s);
    result_.joints.insert(result_.joints.end(), point.d[0].begin(),
                          point.d[0].begin() + static_cast<std::ptrdiff_t>(n_));
  }

  /// How far the joints in the middle are from the cubic through both ends; infinite where they have no place there.
  [[nodiscard]] double surprise(double s_left, const JointPoint& left, double s_right, const JointPoint& right) const {
    JointPoint middle;
    const double h = s_right - s_left;
    if (evaluate(s_left + h / 2, 1, {left.d[0].data(), n_}, middle) != KinematicsStatus::Ok) return HUGE_VAL;
    double most = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      const double cubic = (left.d[0][j] + right.d[0][j]) / 2 + h / 8 * (left.d[1][j] - right.d[1][j]);
      most = std::max(most, std::abs(middle.d[0][j] - cubic));
    }
    return most;
  }

  /// Keeps what it takes from one place, whose point becomes that of the other, to there.
  bool reach(double s_from, JointPoint& point, double s_to) {
    JointPoint there;
    const KinematicsStatus status = evaluate(s_to, -1, {point.d[0].data(), n_}, there);
    const bool reached = status == KinematicsStatus::Ok;
    const bool told = curve_.in_joint_space() || map_.linear();
    const double off = told ? 0 : reached ? surprise(s_from, point, s_to, there) : HUGE_VAL;
    const bool nearest = told || s_to - s_from < 2 * kNearest_mm || places_.size() > curve_.nodes().size() + kMostAdded;
    if (reached && off <= (nearest ? kJump : kKnown)) {
      keep(s_to, there);
      point = there;
      return true;
    }
    if (nearest) return !refuse(reached ? KinematicsStatus::Singular : status, s_to);
    const double middle = s_from + (s_to - s_from) / 2;
    return reach(s_from, point, middle) && reach(middle, point, s_to);
  }

  const Curve& curve_;
  const PoseToJoints& map_;
  std::size_t n_;
  std::vector<double> places_;
  JointNodes result_;
};

}  // namespace

JointNodes joint_nodes(const Curve& curve, const PoseToJoints& map, std::span<const double> start_joints) {
  return Nodes(curve, map).find(start_joints);
}

}  // namespace rmac
