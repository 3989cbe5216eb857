#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "curves/vector.hpp"
#include "path/least_squares.hpp"
#include "rmac/motion/frame.hpp"
#include "short_lines/turn_spline.hpp"
#include "short_lines/turning_curve.hpp"
#include "splines/quintic.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::cross;
using curves::difference;
using curves::dot;
using curves::norm;
using curves::scaled;
using curves::unit;

/// Samples are this near to each other, but no more than so many a line, or so that a joint turns by this between them,
/// and then no more than so many.
constexpr double kNodeSpacing_mm = 0.1, kTurn_deg = 8;
constexpr int kPlainParts = 10, kMostParts = 64;
constexpr double kDegrees = 180 / std::numbers::pi;
constexpr std::size_t kMostTurns = 3, kSlides = 3;
constexpr int kNewtonSteps = 3;
/// Of the lines' lengths, what the tip's path along one is at least.
constexpr double kLeastReachOfALine = 0.05;
/// Widths are no more than what the tool travels in this time, where it is slow, and more by this slope beside it.
constexpr double kWidth_s = 0.025, kSlope = 0.3;
/// Joints are followed by steps in which the axis turns by this part of its distance from the pole, but not less than
/// that: nearer to it lines are no better known.
constexpr double kPartOfLean = 0.3, kLeastTurn = 1e-5;
constexpr int kMostSteps = 400;
/// Joints that differ by more are other solutions, in degrees.
constexpr double kOther_deg = 1;
/// The part of the tolerance of the axis that a way over the pole may take.
constexpr double kOver = 0.95;
/// A way over the pole leaves the lines, and comes back to them, by a bell this wide; towards an end of the run, which
/// is met exactly, within the latter.
constexpr double kBell_mm = 6, kEnd_mm = 3;

Vector axis_at(const PathSegment& line, double s) {
  CurvePoint point;
  line.curve().programmed().evaluate(s, 0, 1, point);
  return {point.d[0][3], point.d[0][4], point.d[0][5]};
}

/// Path lengths at which the tip passes the lines' ends. The first one's, where it lies before the path, is such that
/// the path begins as far along the line as the tool stands.
std::optional<std::vector<double>> places_of(const Polyline& polyline, const TipPath& tip) {
  const std::size_t lines = polyline.lines();
  const auto& vertices = polyline.vertices;
  std::vector<double> places{0};
  for (std::size_t k = 1; k <= lines; ++k) {
    const double line = polyline.places[k] - std::max(polyline.places[k - 1], tip.from);
    double s = places.back() + line;
    if (k == lines) {
      s = tip.length;
    } else {
      const Vector ahead = curves::unit(along(curves::unit(difference(vertices[k], vertices[k - 1])), 1,
                                              curves::unit(difference(vertices[k + 1], vertices[k]))));
      for (int i = 0; i < kNewtonSteps; ++i)
        s = std::clamp(s - dot(ahead, difference(tip.at(s), vertices[k])), 0.0, tip.length);
      s = std::max(s, places.back() + kLeastReachOfALine * line);
    }
    if (!(s > places.back())) return std::nullopt;
    places.push_back(s);
  }
  const Vector first = difference(vertices[1], vertices[0]);
  const double part = std::clamp(dot(difference(tip.at(0), vertices[0]), first) / dot(first, first), 0.0, 0.99);
  places.front() = -part / (1 - part) * places[1];
  return places;
}

/// Follows the tool axis with the joints.
class Following {
 public:
  explicit Following(const PoseToJoints& map) : map_(map), turns_(rotary_joints(map.kinematics())) {
    has_pole_ = map.kinematics().pole(pole_);
    pole_ = apply_to_vector(inverse(map.frames().part), pole_);
  }

  [[nodiscard]] const std::vector<std::size_t>& turns() const { return turns_; }
  [[nodiscard]] bool has_pole() const { return has_pole_; }
  [[nodiscard]] const Vector& pole() const { return pole_; }
  [[nodiscard]] Vector rotary() const { return rotary_of(joints_.data()); }

  /// Stands at a place of a line as the line does.
  bool stand(const PathSegment& line, double s) {
    JointPoint point;
    if (line.evaluate(s, 0, s > 0 ? -1 : 1, point) != KinematicsStatus::Ok) return false;
    std::copy_n(point.d[0].begin(), map_.joint_count(), joints_.begin());
    axis_ = axis_at(line, s);
    tip_ = map_.pose({joints_.data(), map_.joint_count()}).tip;
    return true;
  }
  /// Stands with these rotary joints.
  void turn_to(const Vector& rotary) {
    for (std::size_t i = 0; i < turns_.size(); ++i) joints_[turns_[i]] = rotary[i];
  }
  /// To the solution that is nearest.
  bool jump(const Vector& axis) {
    const ToolPose pose = apply_to_pose(map_.frames().part, {tip_, axis});
    std::array<double, kMaxJoints> found;
    const std::size_t n = map_.joint_count();
    if (map_.kinematics().inverse(pose, map_.frames().tool, {joints_.data(), n}, {found.data(), n}) !=
        KinematicsStatus::Ok)
      return false;
    joints_ = found;
    axis_ = axis;
    return true;
  }
  /// To the solution that one comes to on the way there.
  bool lead(const Vector& axis) {
    for (int i = 0; i < kMostSteps; ++i) {
      const double way = curves::distance(axis_, axis), step = std::max(kPartOfLean * lean(axis_), kLeastTurn);
      if (way <= step) return jump(axis);
      if (!jump(unit(along(axis_, step / way, difference(axis, axis_))))) return false;
    }
    return jump(axis);
  }
  /// Stands at other joints than the line does there, where the axis knows them.
  [[nodiscard]] bool differs(const PathSegment& line, double s) const {
    JointPoint point;
    if (line.evaluate(s, 0, s > 0 ? -1 : 1, point) != KinematicsStatus::Ok) return true;
    if (lean(axis_at(line, s)) < kLeastTurn) return false;
    const Vector off = difference(rotary_of(point.d[0].data()), rotary());
    return std::max({std::abs(off[0]), std::abs(off[1]), std::abs(off[2])}) > kOther_deg;
  }

  /// |d(axis) / d(joint)| of each rotary joint.
  [[nodiscard]] Vector rates() const {
    const std::size_t n = map_.joint_count();
    PoseRows rows;
    map_.kinematics().jacobian({joints_.data(), n}, map_.frames().tool, {rows.data(), 6 * n});
    Vector rates{};
    for (std::size_t i = 0; i < turns_.size(); ++i) {
      const auto row = [&](std::size_t r) { return rows[r * n + turns_[i]]; };
      rates[i] = kDegrees * std::hypot(row(3), row(4), row(5));
    }
    return rates;
  }

 private:
  [[nodiscard]] double lean(const Vector& axis) const { return has_pole_ ? norm(cross(axis, pole_)) : 1; }
  [[nodiscard]] Vector rotary_of(const double* joints) const {
    Vector rotary{};
    for (std::size_t i = 0; i < turns_.size(); ++i) rotary[i] = joints[turns_[i]];
    return rotary;
  }

  const PoseToJoints& map_;
  std::vector<std::size_t> turns_;
  Vector pole_{};
  bool has_pole_ = false;
  std::array<double, kMaxJoints> joints_{};
  Vector axis_{0, 0, 1};
  Vector tip_{};
};

/// Into how many parts a line is divided.
int parts_of(const PathSegment& line, double length, const std::vector<std::size_t>& turns) {
  const auto begin = line.joints_at_node(0), end = line.joints_at_node(line.nodes().size() - 1);
  double most = 0;
  for (const std::size_t j : turns) most = std::max(most, std::abs(end[j] - begin[j]));
  const int by_turn = std::clamp(static_cast<int>(std::ceil(most / kTurn_deg)), 1, kMostParts);
  return std::max(std::min(static_cast<int>(std::round(length / kNodeSpacing_mm)), kPlainParts), by_turn);
}

/// Where a line passes the pole by less than the tolerance: nothing where it does not.
std::optional<OverPole> over_pole(const PathSegment& line, double begin, double end, Vector pole) {
  const Vector from = axis_at(line, 0), to = axis_at(line, line.length());
  if (dot(from, pole) < 0) pole = scaled(-1, pole);
  const Vector circle = unit(cross(from, to));
  const Vector nearest = unit(along(pole, -dot(pole, circle), circle));
  const double part = curves::distance(nearest, from) / std::max(curves::distance(to, from), 1e-12);
  const OverPole over{begin + std::clamp(part, 0.0, 1.0) * (end - begin), difference(nearest, pole)};
  if (!(norm(over.beside) < kOver * line.demand().tolerance_rad)) return std::nullopt;
  return over;
}

/// Samples with the programmed axes, without joints.
void lay_samples(const TurnWindow& window, const std::vector<std::size_t>& turns, TurningLines& turning) {
  const auto& at = turning.joints.places;
  const auto add = [&](std::size_t k, double s) {
    SplineSample& sample = turning.samples.emplace_back();
    sample.place = s;
    sample.line = k;
    const double part = std::clamp((s - at[k]) / (at[k + 1] - at[k]), 0.0, 1.0);
    turning.axes.push_back(axis_at(*window.lines[k], part * window.lines[k]->length()));
  };
  for (std::size_t k = 0; k < window.lines.size(); ++k) {
    const double from = std::max(at[k], 0.0), length = at[k + 1] - from;
    const int parts = parts_of(*window.lines[k], length, turns);
    for (int i = 0; i < parts; ++i) add(k, from + length * i / parts);
  }
  add(window.lines.size() - 1, at.back());
  auto& samples = turning.samples;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const double half = (samples[i + 1].place - samples[i].place) / 2;
    samples[i].share += half;
    samples[i + 1].share += half;
  }
}

/// Finds the samples' joints, one from the other.
class Asking {
 public:
  Asking(const TurnWindow& window, TurningLines& turning)
      : window_(window), turning_(turning), following_(*turning.map) {}

  /// As the lines ask. Where they do not go on as one comes to them, they go over the pole, or false.
  bool follow(std::vector<OverPole>& overs) {
    const auto& at = turning_.joints.places;
    if (!begin()) return false;
    for (std::size_t i = 0; i < turning_.samples.size(); ++i) {
      if (i > 0 && !following_.lead(turning_.axes[i])) return false;
      take(i);
      const std::size_t k = turning_.samples[i].line;
      const bool last = i + 1 == turning_.samples.size() || turning_.samples[i + 1].line != k;
      if (!last) continue;
      const PathSegment& line = *window_.lines[k];
      if (!following_.lead(axis_at(line, line.length()))) return false;
      if (!following_.differs(line, line.length())) continue;
      if (!following_.has_pole()) return false;
      const auto over = over_pole(line, at[k], at[k + 1], following_.pole());
      if (!over || !following_.stand(line, line.length())) return false;
      const bool known = std::any_of(overs.begin(), overs.end(), [&](const OverPole& other) {
        return std::abs(other.place - over->place) < kNodeSpacing_mm;
      });
      if (!known) overs.push_back(*over);
    }
    return true;
  }

  /// Straight over the poles.
  bool go_over(const std::vector<OverPole>& overs) {
    if (!begin()) return false;
    const double length = turning_.samples.back().place;
    const bool fresh = window_.before.empty();
    for (std::size_t i = 0; i < turning_.samples.size(); ++i) {
      const double s = turning_.samples[i].place;
      Vector axis = turning_.axes[i];
      for (const OverPole& over : overs) {
        const double off = (s - over.place) / kBell_mm;
        // Where it comes nearest it is led straight over, however near that is to an end.
        const double ends = end_ramp(length - s, length - over.place) * (fresh ? end_ramp(s, over.place) : 1);
        axis = along(axis, -ends * std::exp(-off * off), over.beside);
      }
      if (!following_.jump(unit(axis))) return false;
      take(i);
    }
    return true;
  }

  /// The last sample is where the lines end, whatever leads there.
  bool end() {
    const PathSegment& line = *window_.lines.back();
    if (following_.differs(line, line.length()) || !following_.stand(line, line.length())) return false;
    take(turning_.samples.size() - 1);
    return true;
  }

 private:
  /// From 0 at an end to 1, half way to a place at the latest.
  static double end_ramp(double to_end, double place_to_end) {
    const double width = std::clamp(place_to_end / 2, 1e-3, kEnd_mm);
    const double part = std::clamp(to_end / width, 0.0, 1.0);
    return part * part * (3 - 2 * part);
  }
  bool begin() {
    const auto& at = turning_.joints.places;
    const PathSegment& line = *window_.lines.front();
    const double part = std::clamp(-at[0] / (at[1] - at[0]), 0.0, 1.0);
    if (!following_.stand(line, part * line.length())) return false;
    if (window_.before.empty()) return true;
    const LineSpline& before = window_.before;
    following_.turn_to(quintic::value(
        quintic::basis(before.knots, before.points.size(), before.knots[quintic::kDegree]), before.points));
    return following_.jump(turning_.axes.front());
  }
  void take(std::size_t sample) {
    turning_.samples[sample].point = following_.rotary();
    turning_.rates[sample] = following_.rates();
  }

  const TurnWindow& window_;
  TurningLines& turning_;
  Following following_;
};

/// Widths by the speed that feed and rotary joints allow: what is even in time.
void bound_widths(const TurnWindow& window, const std::vector<std::size_t>& turns, TurningLines& lines) {
  const double feed_mm_s = window.lines.front()->demand().feed_mm_s;
  auto& samples = lines.samples;
  for (std::size_t k = 0; k + 1 < samples.size(); ++k) {
    const double step = samples[k + 1].place - samples[k].place;
    for (std::size_t i = 0; i < turns.size(); ++i) {
      if (std::min(lines.rates[k][i], lines.rates[k + 1][i]) < kUnknownRate) continue;
      const double turn = std::abs(samples[k + 1].point[i] - samples[k].point[i]);
      const double width = kWidth_s * std::min(feed_mm_s, window.joints[turns[i]].max_speed * step / (turn + 1e-12));
      for (const std::size_t at : {k, k + 1}) samples[at].most_mm = std::min(samples[at].most_mm, width);
    }
  }
  const auto beside = [&](std::size_t from, std::size_t to) {
    const double far = std::abs(samples[to].place - samples[from].place);
    samples[to].most_mm = std::min(samples[to].most_mm, samples[from].most_mm + kSlope * far);
  };
  for (std::size_t k = 1; k < samples.size(); ++k) beside(k - 1, k);
  for (std::size_t k = samples.size() - 1; k-- > 0;) beside(k + 1, k);
}

}  // namespace

bool turns_lead(const Kinematics& kinematics) {
  const std::size_t turns = rotary_joints(kinematics).size();
  return turns > 0 && turns <= kMostTurns && kinematics.joint_count() == kSlides + turns && !kinematics.parallel() &&
         !kinematics.free_joint();
}

void TipPath::add(std::shared_ptr<const Curve> piece) {
  starts.push_back(length);
  length += piece->length();
  pieces.push_back(std::move(piece));
}

Vector TipPath::at(double s) const {
  const auto above = std::upper_bound(starts.begin() + 1, starts.end(), s);
  const auto piece = static_cast<std::size_t>(above - starts.begin()) - 1;
  CurvePoint point;
  pieces[piece]->evaluate(std::clamp(s - starts[piece], 0.0, pieces[piece]->length()), 0, 1, point);
  return {point.d[0][0], point.d[0][1], point.d[0][2]};
}

std::optional<TurningLines> turning_lines(const TurnWindow& window, std::vector<OverPole>& overs) {
  auto places = places_of(window.polyline, window.tip);
  if (!places) return std::nullopt;
  TurningLines turning;
  turning.joints.places = std::move(*places);
  turning.map = window.lines.front()->map();
  const auto turns = rotary_joints(turning.map->kinematics());
  lay_samples(window, turns, turning);
  turning.rates.resize(turning.samples.size());
  Asking asking(window, turning);
  if (!asking.follow(overs) || (!overs.empty() && !asking.go_over(overs)) || !asking.end()) return std::nullopt;
  for (std::size_t i = 0; i < turning.samples.size(); ++i) {
    if (i == 0 || turning.samples[i].line != turning.samples[i - 1].line)
      turning.joints.vertices.push_back(turning.samples[i].point);
  }
  turning.joints.vertices.push_back(turning.samples.back().point);
  bound_widths(window, turns, turning);
  return turning;
}

}  // namespace rmac
