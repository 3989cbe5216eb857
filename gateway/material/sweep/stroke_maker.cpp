#include "gateway/material/sweep/stroke_maker.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {

double StrokeMaker::turned_mm(const ToolAt& from, const ToolAt& to) const {
  // A stroke has the direction half-way between.
  return piece_.lever() * (to.axis - from.axis).norm() / 2;
}

std::optional<Stroke> StrokeMaker::go_to(const ToolAt& there) {
  const Position next{there.tip + piece_.middle * there.axis, there.axis};
  if (passed_.empty()) {
    passed_.push_back(next);
    return std::nullopt;
  }
  if (next.middle == passed_.back().middle && next.axis == passed_.back().axis) return std::nullopt;
  std::optional<Stroke> over;
  if (passed_.size() >= kMost || !on_stroke_to(next)) {
    over = stroke();
    passed_.erase(passed_.begin(), passed_.end() - 1);
  }
  passed_.push_back(next);
  return over;
}

std::optional<Stroke> StrokeMaker::end() {
  if (passed_.size() < 2) return std::nullopt;
  const Stroke over = stroke();
  passed_.erase(passed_.begin(), passed_.end() - 1);
  return over;
}

bool StrokeMaker::on_stroke_to(const Position& there) const {
  const Position& begin = passed_.front();
  const Eigen::Vector3d way = there.middle - begin.middle, axis = (begin.axis + there.axis).normalized();
  const double length2 = way.squaredNorm(), lever = piece_.lever();
  const auto off = [&](const Position& at) {
    const Eigen::Vector3d done = at.middle - begin.middle;
    const double part = length2 > 0 ? std::clamp(done.dot(way) / length2, 0.0, 1.0) : 0;
    const double turned = lever > 0 ? lever * (at.axis - axis).norm() : 0;
    return (done - part * way).norm() + turned;
  };
  // The two ends turn the most, as a rule.
  if (lever > 0 && (off(begin) > tolerance_mm_ || off(there) > tolerance_mm_)) return false;
  return std::ranges::all_of(passed_, [&](const Position& at) { return off(at) <= tolerance_mm_; });
}

Stroke StrokeMaker::stroke() const {
  const Position &begin = passed_.front(), &last = passed_.back();
  return {begin.middle, last.middle, (begin.axis + last.axis).normalized()};
}

}  // namespace rmac::gateway
