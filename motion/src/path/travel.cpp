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
  const auto nodes = segment.curve().nodes();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const double rate = segment.largest_rate(j);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const double here = segment.joints_at_node(i)[j], reach = rate * (nodes[i + 1] - nodes[i]);
      if (beyond(joints[j], here + reach) != 0 || beyond(joints[j], here - reach) != 0) return false;
    }
  }
  return true;
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
  const auto nodes = segment.curve().nodes();
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
    const double h = nodes[i + 1] - nodes[i];
    if (segment.evaluate(nodes[i + 1], 1, -1, right) != KinematicsStatus::Ok) return offence;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      // Where the joint turns between the nodes: the zero of the secant of its derivative is near enough, nodes being
      // dense.
      const double a = left.d[1][j], b = right.d[1][j];
      if (a * b >= 0) continue;
      const double s = nodes[i] + h * a / (a - b);
      if (segment.evaluate(s, 0, 1, turn) == KinematicsStatus::Ok && offends(turn, s)) return offence;
    }
    if (offends(right, nodes[i + 1])) return offence;
    left = right;
  }
  return std::nullopt;
}

}  // namespace rmac
