#include "path/part_of.hpp"

#include <algorithm>
#include <utility>

namespace rmac {
namespace {

/// Stretches laid on [0, length], met from the other end.
std::vector<MoveStretch> reversed(const std::vector<MoveStretch>& stretches, double length) {
  std::vector<MoveStretch> back;
  double end = length;
  for (auto stretch = stretches.rbegin(); stretch != stretches.rend(); ++stretch) {
    const double s_end_mm = stretch->s_begin_mm + stretch->s_per_length * (end - stretch->begin);
    back.push_back({length - end, stretch->move_id, s_end_mm, -stretch->s_per_length, false});
    end = stretch->begin;
  }
  return back;
}

}  // namespace

void append_stretches(const PathSegment& from, double a, double b, double begin, double end,
                      std::vector<MoveStretch>& stretches) {
  const auto all = from.stretches();
  const double rate = (end - begin) / (b - a);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double stretch_end = i + 1 < all.size() ? all[i + 1].begin : from.length();
    if (stretch_end <= a && i + 1 < all.size()) continue;
    if (all[i].begin >= b) break;
    MoveStretch part = all[i];
    const double cut = std::max(a - part.begin, 0.0);
    part.s_begin_mm += part.s_per_length * cut;
    part.begin = begin + rate * (std::max(part.begin, a) - a);
    part.s_per_length /= rate;
    part.last_of_move = part.last_of_move && stretch_end <= b;
    stretches.push_back(part);
  }
}

std::shared_ptr<const PathSegment> part_of(const PathSegment& whole, double begin, double end, Direction direction) {
  const bool backward = direction == Direction::Backward;
  std::vector<MoveStretch> stretches;
  append_stretches(whole, begin, end, 0, end - begin, stretches);
  PathDemand demand = whole.demand();
  demand.rest_before = demand.rest_before && begin == 0;
  demand.rest_after = demand.rest_after && end == whole.length();
  if (backward) {
    stretches = reversed(stretches, end - begin);
    std::swap(demand.rest_before, demand.rest_after);
  }
  auto part = std::make_shared<PathSegment>(std::make_shared<TrimmedCurve>(whole.shared_curve(), begin, end, direction),
                                            whole.map(), demand, std::move(stretches));
  JointPoint start;
  double s_failed = 0;
  // The whole was resolved, so its parts have solutions too.
  if (whole.evaluate(backward ? end : begin, 0, backward ? -1 : 1, start) == KinematicsStatus::Ok)
    (void)part->resolve({start.d[0].data(), whole.joint_count()}, s_failed);
  return part;
}

}  // namespace rmac
