#include "path/pole_passage.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "curves/vector.hpp"
#include "path/travel.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac {
namespace {

/// Steps along the curve turn the axis by this part of its distance from the pole, which keeps the joint that turns
/// about the pole below 20 degrees a step; inside the cap by the same part of the cap.
constexpr double kPartOfLean = 0.25;
constexpr double kPartOfCap = 0.125;
/// Beyond this lean, in rad, the curve's own nodes do.
constexpr double kFarFromPole = 0.35;
/// Nodes are added where the direction of the lean has turned by this much, in rad; the joint turns with it.
constexpr double kNodeTurn = 0.2;
/// A tool this close to the pole at the end of a curve stands on it: what programs round off, in rad.
constexpr double kOnPole = 5e-7;
/// Shorter stretches, in mm, are left to the curve.
constexpr double kLeastStretch_mm = 1e-4;
/// On a passage, by this many degrees of the joint that turns most.
constexpr double kPassageTurn = 3;
constexpr double kLeastPassageNodes = 4;
constexpr std::size_t kMostSolutions = 16;
/// Lines that pass the pole nearer than this part of cap and tolerance are led straight over it.
constexpr double kOver = 0.9;
/// A line comes nearest to the pole where its way there, from straight ahead (-1) to straight behind (1), begins below
/// this and ends above it.
constexpr double kAside = -0.02;

Vector axis_of(const CurvePoint& point, std::size_t order = 0) {
  return {point.d[order][3], point.d[order][4], point.d[order][5]};
}

/// Angle between two directions, in rad.
double angle(const Vector& a, const Vector& b) {
  return std::atan2(curves::norm(curves::cross(a, b)), curves::dot(a, b));
}

/// From the line of the pole, whichever of its ends is nearer.
double lean_of(const Vector& axis, const Vector& pole) {
  return std::atan2(curves::norm(curves::cross(axis, pole)), std::abs(curves::dot(axis, pole)));
}

/// Where, between a point outside of the cap and one inside, its border is.
double border(const Curve& curve, const Vector& pole, double outside, double inside) {
  CurvePoint point;
  for (int i = 0; i < 60 && std::abs(inside - outside) > 1e-9; ++i) {
    const double middle = (outside + inside) / 2;
    curve.evaluate(middle, 0, 1, point);
    (lean_of(axis_of(point), pole) < kPoleCap ? inside : outside) = middle;
  }
  return outside;
}

bool turns(const Curve& curve) {
  constexpr double kStill = 1e-12;
  CurvePoint first, here;
  curve.evaluate(0, 0, 1, first);
  const auto nodes = curve.nodes();
  return std::any_of(nodes.begin(), nodes.end(), [&](double s) {
    curve.evaluate(s, 1, s > 0 ? -1 : 1, here);
    return angle(axis_of(first), axis_of(here)) > kStill || curves::norm(axis_of(here, 1)) > kStill;
  });
}

}  // namespace

PoleMap map_pole(const Curve& curve, const Vector& pole) {
  PoleMap map;
  if (curve.in_joint_space() || !turns(curve)) return map;
  const auto nodes = curve.nodes();
  CurvePoint point;
  double s = 0;
  double before = 0;
  bool was_inside = false;
  // A lean on the other side of the pole is no turn: there the other joint changes its sign.
  const auto turned = [&](const Vector& a, const Vector& b) {
    const Vector p = curves::cross(pole, a), q = curves::cross(pole, b);
    const double across = curves::norm(curves::cross(p, q)), along = std::abs(curves::dot(p, q));
    return std::atan2(across, along);
  };
  curve.evaluate(0, 0, 1, point);
  Vector at_node = axis_of(point);
  for (std::size_t next = 1;;) {
    curve.evaluate(s, 1, s < curve.length() ? 1 : -1, point);
    const double lean = lean_of(axis_of(point), pole);
    const bool inside = lean < kPoleCap;
    if (inside && !was_inside) map.passages.push_back({s > 0 ? border(curve, pole, before, s) : 0, curve.length()});
    if (!inside && was_inside) map.passages.back().end = border(curve, pole, s, before);
    was_inside = inside;
    before = s;
    if (next >= nodes.size()) break;
    const double rate = curves::norm(axis_of(point, 1));
    const double turn = std::max(kPartOfLean * lean, kPartOfCap * kPoleCap);
    const double step = lean < kFarFromPole && rate > 0 ? turn / rate : curve.length();
    const bool far = turned(at_node, axis_of(point)) > kNodeTurn;
    if (far && s > 0) map.nodes.push_back(s);
    if (far || s == nodes[next - 1]) at_node = axis_of(point);
    if (s + step < nodes[next] - step / 4) {
      s += step;
    } else {
      s = nodes[next++];
    }
  }
  std::erase_if(map.passages, [](const auto& stretch) { return stretch.end - stretch.begin < kLeastStretch_mm; });
  // What is left of a curve before its first or behind its last passage must be worth a segment.
  for (auto& stretch : map.passages) {
    if (stretch.begin < kLeastStretch_mm) stretch.begin = 0;
    if (stretch.end > curve.length() - kLeastStretch_mm) stretch.end = curve.length();
  }
  return map;
}

TurnWay::TurnWay(const TurnState& begin, const TurnState& end, double length) noexcept : length_(length) {
  auto& c = coefficient_;
  const double l2 = length * length, l3 = l2 * length;
  c[0] = begin[0];
  c[1] = begin[1] * length;
  c[2] = begin[2] * l2 / 2;
  c[3] = begin[3] * l3 / 6;
  // What the first four leave for the last four to reach at the end, by order of derivative.
  const double r0 = end[0] - (c[0] + c[1] + c[2] + c[3]);
  const double r1 = end[1] * length - (c[1] + 2 * c[2] + 3 * c[3]);
  const double r2 = end[2] * l2 - (2 * c[2] + 6 * c[3]);
  const double r3 = end[3] * l3 - 6 * c[3];
  c[4] = 35 * r0 - 15 * r1 + 2.5 * r2 - r3 / 6;
  c[5] = -84 * r0 + 39 * r1 - 7 * r2 + r3 / 2;
  c[6] = 70 * r0 - 34 * r1 + 6.5 * r2 - r3 / 2;
  c[7] = -20 * r0 + 10 * r1 - 2 * r2 + r3 / 6;
}

double TurnWay::at(double s, std::size_t order) const noexcept {
  const double u = s / length_;
  double value = 0;
  for (std::size_t k = coefficient_.size(); k-- > order;) {
    double factor = 1;
    for (std::size_t m = 0; m < order; ++m) factor *= static_cast<double>(k - m);
    value = value * u + factor * coefficient_[k];
  }
  return value / std::pow(length_, static_cast<double>(order));
}

PolePassage::PolePassage(std::shared_ptr<const Curve> stretch, std::vector<TurnWay> turns,
                         std::shared_ptr<const PoseToJoints> map)
    : stretch_(std::move(stretch)), turns_(std::move(turns)), map_(std::move(map)) {
  nodes_.assign(stretch_->nodes().begin(), stretch_->nodes().end());
  double most = 0;
  for (const TurnWay& way : turns_) most = std::max(most, std::abs(way.at(length(), 0) - way.at(0, 0)));
  const double parts = std::max(kLeastPassageNodes, std::ceil(most / kPassageTurn));
  for (double i = 1; i < parts; ++i) nodes_.push_back(stretch_->length() * i / parts);
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
}

void PolePassage::evaluate(double s, int order, int side, CurvePoint& point) const noexcept {
  stretch_->evaluate(s, order, side, point);
  for (std::size_t k = 0; k <= static_cast<std::size_t>(order); ++k) {
    for (std::size_t i = 0; i < turns_.size(); ++i) point.d[k][6 + i] = turns_[i].at(s, k);
  }
  // Slides carry the axis along as it is, so they may stand anywhere.
  std::array<double, kMaxJoints> joints{};
  std::size_t turn = 0;
  for (std::size_t j = 0; j < map_->joint_count(); ++j) {
    if (map_->kinematics().joint_type(j) == JointType::Rotary) joints[j] = point.d[0][6 + turn++];
  }
  const Vector axis = map_->pose({joints.data(), map_->joint_count()}).axis;
  std::copy(axis.begin(), axis.end(), point.d[0].begin() + 3);
}

std::pair<double, double> PolePassage::largest_deviation() const {
  constexpr int kSamples = 128;
  std::pair<double, double> largest;
  CurvePoint wanted, point;
  for (int i = 0; i <= kSamples; ++i) {
    const double s = length() * i / kSamples;
    stretch_->evaluate(s, 0, 1, wanted);
    evaluate(s, 0, 1, point);
    const double off = angle(axis_of(wanted), axis_of(point));
    if (off > largest.first) largest = {off, s};
  }
  return largest;
}

namespace {

/// The rotary joints' states where a passage ends.
struct PoleExit {
  std::vector<TurnState> turns;
  double time_s = 0;  ///< of the joint that takes longest at its limit of speed
  double turn = 0;    ///< of the joint that turns most, in degrees
  bool offends = false;
};

/// How a curve's axis stands to the pole at one of its ends.
struct Leaning {
  double away = 0;   ///< -1 where it goes straight to the pole, 1 straight away from it
  double least = 0;  ///< how near its great circle comes to the pole: the sine
  Vector aside{};    ///< where it leans to, across the pole

  Leaning(const Curve& curve, double s, const Vector& pole) {
    CurvePoint point;
    curve.evaluate(s, 1, s > 0 ? -1 : 1, point);
    const Vector axis = axis_of(point), rate = axis_of(point, 1);
    const double height = curves::dot(axis, pole), fast = curves::norm(rate);
    aside = curves::along(axis, -height, pole);
    const double across = curves::norm(aside);
    if (fast * across > 0) away = -std::copysign(1.0, height) * curves::dot(rate, pole) / (fast * across);
    least = fast > 0 ? std::abs(curves::dot(curves::cross(axis, rate), pole)) / fast : across;
  }
};

/// The turn, in degrees, of the solution that a line that will be smoothed is to be led to where it comes nearest to
/// the pole: straight over it if the tolerance lets it, or as its axis goes. Nothing elsewhere.
std::optional<double> wanted_turn(const Curve& stretch, const Vector& pole, double tolerance_rad) {
  if (!(tolerance_rad > 0) || !stretch.even()) return std::nullopt;
  const Leaning begin(stretch, 0, pole), end(stretch, stretch.length(), pole);
  if (!(begin.away < kAside && end.away >= kAside)) return std::nullopt;
  constexpr double kDegrees = 57.29577951308232;
  const double turn = kDegrees * angle(begin.aside, end.aside);
  return begin.least < kOver * std::min(tolerance_rad, kPoleCap) ? 180 - turn : turn;
}

/// Joints that put the tool where the stretch ends; on the pole itself if the curve ends that close to it.
std::vector<double> end_joints(const Curve& stretch, bool curve_ends, const PoseToJoints& map,
                               std::span<const double> seed) {
  const Kinematics& kinematics = map.kinematics();
  CurvePoint point;
  stretch.evaluate(stretch.length(), 0, -1, point);
  ToolPose pose = apply_to_pose(map.frames().part, {{point.d[0][0], point.d[0][1], point.d[0][2]}, axis_of(point)});
  Vector pole{};
  if (kinematics.pole(pole) && curve_ends && lean_of(pose.axis, pole) < kOnPole) {
    pose.axis = curves::scaled(curves::dot(pose.axis, pole) < 0 ? -1 : 1, pole);
  }
  std::vector<double> all(kMostSolutions * kinematics.joint_count());
  all.resize(kinematics.solutions(pose, map.frames().tool, seed, all) * kinematics.joint_count());
  return all;
}

}  // namespace

std::vector<std::shared_ptr<const PolePassage>> pole_passages(const std::shared_ptr<const Curve>& stretch,
                                                              const PoleEntry& entry,
                                                              const std::shared_ptr<const Curve>& next,
                                                              const std::shared_ptr<const PoseToJoints>& map,
                                                              const std::vector<JointLimits>& joints) {
  const std::size_t n = joints.size();
  std::vector<std::size_t> turning;
  for (std::size_t j = 0; j < n; ++j) {
    if (map->kinematics().joint_type(j) == JointType::Rotary) turning.push_back(j);
  }
  const auto states_of = [&](const JointPoint& point, std::size_t orders) {
    std::vector<TurnState> states(turning.size());
    for (std::size_t i = 0; i < turning.size(); ++i) {
      for (std::size_t k = 0; k < orders; ++k) states[i][k] = point.d[k][turning[i]];
    }
    return states;
  };
  JointPoint begin;
  std::copy(entry.joints.begin(), entry.joints.end(), begin.d[0].begin());
  const bool known =
      entry.before != nullptr && entry.before->evaluate(entry.before->length(), 3, -1, begin) == KinematicsStatus::Ok;
  const std::vector<TurnState> from = states_of(begin, known ? 4 : 1);

  std::vector<PoleExit> exits;
  std::vector<double> solutions = end_joints(*stretch, next == nullptr, *map, entry.joints);
  for (std::size_t first = 0; first < solutions.size(); first += n) {
    const std::span<double> solution(solutions.data() + first, n);
    for (const std::size_t j : turning) solution[j] = unwound(joints[j], solution[j]);
    PoleExit exit;
    for (const std::size_t j : turning) {
      exit.time_s = std::max(exit.time_s, std::abs(solution[j] - entry.joints[j]) / joints[j].max_speed);
      exit.turn = std::max(exit.turn, std::abs(solution[j] - entry.joints[j]));
    }
    JointPoint end;
    std::copy(solution.begin(), solution.end(), end.d[0].begin());
    if (next) {
      PathSegment rest(next, map, {}, {MoveStretch{}});
      double s_failed = 0;
      if (rest.resolve(solution, s_failed) != KinematicsStatus::Ok ||
          rest.evaluate(0, 3, 1, end) != KinematicsStatus::Ok)
        continue;
      exit.offends = find_offence(rest, joints).has_value();
    } else {
      const auto excess = excess_of(solution, joints);
      exit.offends = std::any_of(excess.begin(), excess.end(), [](double amount) { return amount != 0; });
    }
    exit.turns = states_of(end, next ? 4 : 1);
    exits.push_back(std::move(exit));
  }
  Vector pole{};
  (void)map->kinematics().pole(pole);
  const auto wanted = wanted_turn(*stretch, apply_to_vector(inverse(map->frames().part), pole), entry.tolerance_rad);
  std::stable_sort(exits.begin(), exits.end(), [&](const PoleExit& a, const PoleExit& b) {
    const auto cost = [&](const PoleExit& exit) { return wanted ? std::abs(exit.turn - *wanted) : exit.time_s; };
    return std::pair(a.offends, cost(a)) < std::pair(b.offends, cost(b));
  });

  std::vector<std::shared_ptr<const PolePassage>> passages;
  for (const PoleExit& exit : exits) {
    std::vector<TurnWay> ways;
    for (std::size_t i = 0; i < turning.size(); ++i) ways.emplace_back(from[i], exit.turns[i], stretch->length());
    passages.push_back(std::make_shared<const PolePassage>(stretch, std::move(ways), map));
  }
  return passages;
}

}  // namespace rmac
