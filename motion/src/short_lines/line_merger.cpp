#include "short_lines/line_merger.hpp"

#include <algorithm>
#include <span>

#include "curves/build.hpp"
#include "curves/vector.hpp"
#include "path/part_of.hpp"
#include "path/travel.hpp"
#include "short_lines/alike.hpp"

namespace rmac {
namespace {

using curves::along;
using curves::difference;
using curves::distance;
using curves::dot;
using Lines = std::span<const std::shared_ptr<const PathSegment>>;

/// The part of the tolerance that one line for several may use, and below which a line is not to stay alone.
constexpr double kPartForMerge = 0.5;
/// Corners that one line may pass by.
constexpr std::size_t kMostInChain = 64;
/// A line has at least this much for each one that it stands for: far above what tells two places of a path apart.
constexpr double kLeastStretch_mm = 1e-5;

bool may_merge(const PathSegment& line) {
  const PathDemand& demand = line.demand();
  const Curve& curve = line.curve();
  return demand.tolerance_mm > 0 && curve.straight() && !curve.in_joint_space() && curve.dimension() == 6 &&
         !demand.rest_before && !demand.rest_after;
}

double allowed_mm(const PathSegment& line) {
  return kPartForMerge * line.demand().tolerance_mm;
}
double allowed_rad(const PathSegment& line) {
  return kPartForMerge * line.demand().tolerance_rad;
}

ToolPose pose_at(const PathSegment& line, double s) {
  CurvePoint point;
  line.curve().evaluate(s, 0, 1, point);
  const auto& d = point.d[0];
  return {{d[0], d[1], d[2]}, {d[3], d[4], d[5]}};
}

ToolPose begin_of(Lines lines) {
  return pose_at(*lines.front(), 0);
}
ToolPose end_of(Lines lines) {
  return pose_at(*lines.back(), lines.back()->length());
}

/// How far tip and tool axis of the corners between lines are from the straight way between their ends.
struct Off {
  double mm = 0, rad = 0;
};
Off off(Lines lines) {
  const ToolPose begin = begin_of(lines), end = end_of(lines);
  const Vector ahead = difference(end.tip, begin.tip), turn = difference(end.axis, begin.axis);
  const double square = dot(ahead, ahead);
  Off off;
  for (const auto& line : lines.first(lines.size() - 1)) {
    const ToolPose corner = pose_at(*line, line->length());
    const double part = square > 0 ? std::clamp(dot(difference(corner.tip, begin.tip), ahead) / square, 0.0, 1.0) : 0;
    off.mm = std::max(off.mm, distance(corner.tip, along(begin.tip, part, ahead)));
    off.rad = std::max(off.rad, distance(corner.axis, along(begin.axis, part, turn)));
  }
  return off;
}

/// One line for all; null where they lead nowhere, or joints do not follow it.
std::shared_ptr<const PathSegment> one_line(Lines lines, const std::vector<JointLimits>& joints) {
  auto curve = curves::make_line(begin_of(lines), end_of(lines));
  if (!curve || *curve == nullptr || !(*curve)->straight()) return nullptr;
  const double length = (*curve)->length(), least = kLeastStretch_mm * static_cast<double>(lines.size());
  if (length < least) return nullptr;

  double sum = 0;
  for (const auto& line : lines) sum += line->length();
  std::vector<MoveStretch> stretches;
  double to = 0;
  for (const auto& line : lines) {
    const double from = to;
    to = line == lines.back() ? length : from + kLeastStretch_mm + (length - least) * line->length() / sum;
    append_stretches(*line, 0, line->length(), from, to, stretches);
  }
  PathDemand demand = lines.back()->demand();
  const auto [mm, rad] = off(lines);
  demand.deviation_mm = mm;
  demand.deviation_rad = rad;
  auto whole = std::make_shared<PathSegment>(std::move(*curve), lines.front()->map(), demand, std::move(stretches));
  double s_failed = 0;
  if (whole->resolve(lines.front()->joints_at_node(0), s_failed) != KinematicsStatus::Ok ||
      find_offence(*whole, joints))
    return nullptr;
  return whole;
}

}  // namespace

void LineMerger::add(std::shared_ptr<const PathSegment> segment, const std::vector<JointLimits>& joints,
                     SegmentQueue& out) {
  if (!chain_.empty()) {
    const double allowed = allowed_mm(*chain_.front());
    chain_.push_back(segment);
    const bool one = chain_.size() <= kMostInChain && may_merge(*segment) && alike(*chain_.front(), *segment);
    const Off missed = one ? off(chain_) : Off{};
    if (one && missed.mm <= allowed && missed.rad <= allowed_rad(*segment)) {
      if (distance(begin_of(chain_).tip, end_of(chain_).tip) >= allowed) flush(joints, out);
      return;
    }
    chain_.pop_back();
    flush(joints, out);
  }
  if (may_merge(*segment) && segment->length() < allowed_mm(*segment)) {
    chain_.push_back(std::move(segment));
  } else {
    out.push_back(std::move(segment));
  }
}

void LineMerger::flush(const std::vector<JointLimits>& joints, SegmentQueue& out) {
  auto whole = chain_.size() > 1 ? one_line(chain_, joints) : nullptr;
  if (whole) {
    count_ += chain_.size() - 1;
    out.push_back(std::move(whole));
  } else {
    out.insert(out.end(), chain_.begin(), chain_.end());
  }
  chain_.clear();
}

}  // namespace rmac
