#include "joins/path_joiner.hpp"

#include <algorithm>
#include <utility>

#include "joins/blend.hpp"
#include "path/join.hpp"
#include "path/part_of.hpp"

namespace rmac {
namespace {

/// Each of a segment's two joins may take half of it; what remains between them is nothing, or at least this part.
constexpr double kHalf = 0.5;
constexpr double kLeastRest = 0.02;

}  // namespace

PathJoiner::PathJoiner(std::vector<JointLimits> joints, double period_s)
    : joints_(std::move(joints)), period_s_(period_s), lines_(joints_) {}

void PathJoiner::clear() {
  lines_.clear();
  incoming_.clear();
  current_ = nullptr;
}

bool PathJoiner::ready() const noexcept {
  if (!incoming_.empty() || lines_.ready()) return true;
  // Without a tolerance of its own a move is not held back: its successor will hardly have one.
  return current_ != nullptr && lines_.empty() && !(current_->demand().tolerance_mm > 0);
}

void PathJoiner::emit(double begin, double end, PathSegments& out) {
  if (begin == 0 && end == current_->length()) {
    out.push_back(current_);
    return;
  }
  if (end > begin) out.push_back(part_of(*current_, begin, end));
}

void PathJoiner::advance(PathSegments& out) {
  if (incoming_.empty()) lines_.advance(false, incoming_);
  if (current_ == nullptr) {
    if (incoming_.empty()) return;
    current_ = std::move(incoming_.front());
    incoming_.pop_front();
    begin_ = 0;
    return;
  }
  const double length = current_->length();
  if (incoming_.empty()) {
    if (!lines_.empty() || current_->demand().tolerance_mm > 0) return;
    emit(begin_, length, out);
    current_ = nullptr;
    return;
  }
  std::shared_ptr<const PathSegment> next = std::move(incoming_.front());
  incoming_.pop_front();
  Blend blend;
  if (next->demand().tolerance_mm > 0 && !passes_at_speed(*current_, *next, joints_, period_s_)) {
    double room = kHalf * std::min(length, next->length());
    blend = make_blend(*current_, *next, room, joints_);
    const auto leaves_sliver = [&](double whole) {
      return blend.reach < kHalf * whole && blend.reach > (kHalf - kLeastRest) * whole;
    };
    for (const double whole : {length, next->length()}) {
      if (!leaves_sliver(whole)) continue;
      room = std::min(room, (kHalf - kLeastRest) * whole);
      blend = make_blend(*current_, *next, room, joints_);
    }
  }
  emit(begin_, length - blend.reach, out);
  if (blend.segment) out.push_back(std::move(blend.segment));
  current_ = std::move(next);
  begin_ = blend.reach;
}

void PathJoiner::release(PathSegments& out) {
  if (incoming_.empty()) lines_.advance(true, incoming_);
  if (current_ != nullptr && !incoming_.empty()) {
    advance(out);
    return;
  }
  if (current_ == nullptr) {
    if (incoming_.empty()) return;
    current_ = std::move(incoming_.front());
    incoming_.pop_front();
    begin_ = 0;
  }
  const double length = current_->length();
  if (begin_ < (kHalf - kLeastRest) * length && current_->demand().tolerance_mm > 0) {
    emit(begin_, kHalf * length, out);
    begin_ = kHalf * length;
    return;
  }
  emit(begin_, length, out);
  current_ = nullptr;
}

}  // namespace rmac
