#include "joins/path_joiner.hpp"

#include <algorithm>
#include <utility>

#include "path/join.hpp"
#include "path/part_of.hpp"

namespace rmac {
namespace {

/// Each of a segment's two joins may take half of it; what remains between them is nothing, or at least this part.
constexpr double kHalf = 0.5;
constexpr double kLeastRest = 0.02;
/// Lines that are too short for joins, and are waited for.
constexpr std::size_t kMostPassed = 8;

}  // namespace

PathJoiner::PathJoiner(std::vector<JointLimits> joints, double period_s)
    : joints_(std::move(joints)), period_s_(period_s), lines_(joints_) {}

void PathJoiner::clear() {
  lines_.clear();
  incoming_.clear();
  current_ = nullptr;
}

std::size_t PathJoiner::lines_to_pass() const noexcept {
  if (current_ == nullptr) return 0;
  std::size_t count = 0;
  double length = 0;
  for (const auto& line : incoming_) {
    length += line->length();
    if (!(length < kShortestBlended_mm) || !line->curve().straight() || !(line->demand().tolerance_mm > 0) ||
        line->demand().rest_after)
      break;
    ++count;
  }
  // Asked last: it takes kinematics, and hardly a segment comes so far.
  return count > 0 && !passes_at_speed(*current_, *incoming_.front(), joints_, period_s_) ? count : 0;
}

bool PathJoiner::looks_further() const noexcept {
  return !incoming_.empty() && incoming_.size() <= kMostPassed && lines_to_pass() == incoming_.size();
}

bool PathJoiner::ready() const noexcept {
  if (lines_.ready()) return true;
  if (!incoming_.empty()) return !looks_further();
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

Blend PathJoiner::blend_over(std::size_t over) const {
  const PathSegment& next = *incoming_[over];
  const std::vector<std::shared_ptr<const PathSegment>> passed(incoming_.begin(),
                                                               incoming_.begin() + static_cast<std::ptrdiff_t>(over));
  const double length = current_->length();
  double room = kHalf * std::min(length, next.length());
  Blend blend = make_blend(*current_, passed, next, room, joints_);
  const auto leaves_sliver = [&](double whole) {
    return blend.reach < kHalf * whole && blend.reach > (kHalf - kLeastRest) * whole;
  };
  for (const double whole : {length, next.length()}) {
    if (!leaves_sliver(whole)) continue;
    room = std::min(room, (kHalf - kLeastRest) * whole);
    blend = make_blend(*current_, passed, next, room, joints_);
  }
  return blend;
}

void PathJoiner::advance(PathSegments& out) {
  const std::uint64_t work = lines_.work();
  while ((incoming_.empty() || looks_further()) && lines_.ready() && lines_.work() == work)
    lines_.advance(false, incoming_);
  if (!looks_further()) go_on(out);
}

void PathJoiner::go_on(PathSegments& out) {
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
  Blend blend;
  std::size_t over = lines_to_pass();
  if (over > 0 && over < incoming_.size()) blend = blend_over(over);
  if (!blend.segment) {
    over = 0;
    const PathSegment& next = *incoming_.front();
    if (next.demand().tolerance_mm > 0 && !passes_at_speed(*current_, next, joints_, period_s_)) blend = blend_over(0);
  }
  emit(begin_, length - blend.reach, out);
  if (blend.segment) out.push_back(std::move(blend.segment));
  current_ = std::move(incoming_[over]);
  incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(over) + 1);
  begin_ = blend.reach;
}

void PathJoiner::release(PathSegments& out) {
  if (incoming_.empty() || looks_further()) {
    lines_.advance(true, incoming_);
    if ((incoming_.empty() || looks_further()) && lines_.ready()) return;
  }
  if (current_ != nullptr && !incoming_.empty()) {
    go_on(out);
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
