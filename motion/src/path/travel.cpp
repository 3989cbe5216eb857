#include "path/travel.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {
namespace {

/// A joint may stand this far beyond its limit, in mm or degrees: rounding of a move that ends exactly on it.
constexpr double kTravelSlack = 1e-6;

/// How far joint j is beyond its travel, with sign; 0 inside.
double beyond(const JointLimits& joint, double position) {
  if (ends_above(joint) && position > joint.max + kTravelSlack) return position - joint.max;
  if (ends_below(joint) && position < joint.min - kTravelSlack) return position - joint.min;
  return 0;
}

/// No joint can come to its limits on the way from one node to the next.
bool surely_inside(const PathSegment& segment, const std::vector<JointLimits>& joints) {
  const auto nodes = segment.nodes();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double rate = segment.largest_rate(j);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double here = segment.joints_at_node(i)[j], reach = rate * (nodes[i + 1] - nodes[i]);
      if (beyond(joints[j], here + reach) != 0 || beyond(joints[j], here - reach) != 0) return false;
    }
  }
  return true;
}

/// A joint's rate at a path length.
struct Rate {
  double s, rate;
};

/// Where the joint turns between two nodes, at which its rates have opposite signs: two steps of regula falsi, nodes
/// being dense.
double turning_place(const PathSegment& segment, Rate left, Rate right, std::size_t joint) {
  const auto secant_zero = [&] { return left.s + (right.s - left.s) * left.rate / (left.rate - right.rate); };
  const double s = secant_zero();
  JointPoint there;
  if (segment.evaluate(s, 1, 1, there) != KinematicsStatus::Ok || there.d[1][joint] == 0) return s;
  (there.d[1][joint] * left.rate > 0 ? left : right) = {s, there.d[1][joint]};
  return secant_zero();
}

}  // namespace

std::vector<double> excess_of(std::span<const double> positions, const std::vector<JointLimits>& joints) {
  std::vector<double> excess;
  excess.reserve(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) excess.push_back(beyond(joints[j], positions[j]));
  return excess;
}

std::optional<TravelOffence> find_offence(const PathSegment& segment, const std::vector<JointLimits>& joints) {
  std::vector<double> inside(joints.size(), 0.0);
  return find_offence(segment, joints, inside);
}

std::optional<TravelOffence> find_offence(const PathSegment& segment, const std::vector<JointLimits>& joints,
                                          std::span<double> excess) {
  const bool starts_inside = std::all_of(excess.begin(), excess.end(), [](double amount) { return amount == 0; });
  if (starts_inside && surely_inside(segment, joints)) return std::nullopt;
  const auto nodes = segment.nodes();
  JointPoint left, right, turn;
  TravelOffence offence;
  const auto offends = [&](const JointPoint& point, double s) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double amount = beyond(joints[j], point.d[0][j]);
      const bool on_its_way_in = amount * excess[j] > 0 && std::abs(amount) <= std::abs(excess[j]) + kTravelSlack;
      if (amount != 0 && !on_its_way_in) {
        offence = {j, point.d[0][j], amount, s};
        return true;
      }
      if (std::abs(amount) < std::abs(excess[j])) excess[j] = amount;
    }
    return false;
  };
  if (segment.evaluate(nodes[0], 1, 1, left) != KinematicsStatus::Ok || offends(left, nodes[0])) return offence;
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    if (segment.evaluate(nodes[i + 1], 1, -1, right) != KinematicsStatus::Ok) return offence;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double a = left.d[1][j], b = right.d[1][j];
      if (a * b >= 0) continue;
      const double s = turning_place(segment, {nodes[i], a}, {nodes[i + 1], b}, j);
      if (segment.evaluate(s, 0, 1, turn) == KinematicsStatus::Ok && offends(turn, s)) return offence;
    }
    if (offends(right, nodes[i + 1])) return offence;
    left = right;
  }
  return std::nullopt;
}

}  // namespace rmac
