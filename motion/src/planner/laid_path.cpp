#include "planner/laid_path.hpp"

#include <algorithm>
#include <utility>

#include "path/join.hpp"
#include "path/part_of.hpp"

namespace rmac {
namespace {

/// So many segments stay remembered behind the tool, for a retrace; twice as many before they are dropped together.
constexpr std::size_t kKeptBehind = 1000;

/// Brings what is certain before the gate, or does a part of the work that it takes.
void hand_over(PathJoiner& joiner, BeforeGate& gate) {
  PathSegments fresh;
  joiner.advance(fresh);
  gate.hand_over(std::move(fresh));
}

}  // namespace

LaidPath::LaidPath(std::vector<JointLimits> joints, double period_s)
    : joints_(std::move(joints)), period_s_(period_s), joiner_(joints_, period_s) {}

void LaidPath::add(PathSegments moves) {
  for (auto& segment : moves) {
    moves_left_ += segment->moves_ended(-1, segment->length());
    joiner_.add(std::move(segment));
  }
}

void LaidPath::clear(double s) {
  segments_.clear();
  starts_.clear();
  rest_after_.clear();
  joiner_.clear();
  gate.clear();
  moves_left_ = 0;
  origin_ = s;
  counted_s_ = s;
}

void LaidPath::append(std::shared_ptr<const PathSegment> segment) {
  if (!segments_.empty())
    rest_after_.back() = static_cast<char>(!passes_at_speed(*segments_.back(), *segment, joints_, period_s_));
  starts_.push_back(end());
  rest_after_.push_back(static_cast<char>(segment->demand().rest_after));
  segments_.push_back(std::move(segment));
}

void LaidPath::lay(const PathSegments& fresh) {
  for (const auto& segment : fresh) append(segment);
}

bool LaidPath::supply() {
  PathSegments fresh;
  const std::uint64_t work = joiner_.work();
  if (gate.closed()) {
    while (gate.wants_more() && joiner_.ready() && joiner_.work() == work) hand_over(joiner_, gate);
    gate.take(fresh);
    lay(fresh);
    return !fresh.empty();
  }
  while (fresh.empty() && joiner_.ready() && joiner_.work() == work) joiner_.advance(fresh);
  lay(fresh);
  return !fresh.empty();
}

void LaidPath::release() {
  if (gate.blocked()) return;
  PathSegments fresh;
  joiner_.release(fresh);
  if (gate.closed()) {
    gate.hand_over(std::exchange(fresh, {}));
    gate.take(fresh);
  }
  lay(fresh);
}

double LaidPath::next_rest(double s, double otherwise) const noexcept {
  for (std::size_t i = view().find(s, 1); i < size() && starts_[i] < otherwise; ++i) {
    if (rest_after(i)) return std::min(otherwise, end(i));
  }
  return otherwise;
}

double LaidPath::next_move_end(double s) {
  for (std::size_t i = view().find(s + kSamePlace, 1);; ++i) {
    while (i >= size() + gate.size() && !joiner_.empty() && !gate.blocked()) {
      // How far a move goes is known before the gate says whether it may.
      if (!joiner_.ready()) {
        release();
      } else if (gate.closed()) {
        hand_over(joiner_, gate);
      } else {
        supply();
      }
    }
    if (i >= size() + gate.size()) return gate.end(end());
    double start = i < size() ? starts_[i] : 0;
    const PathSegment& segment = i < size() ? *segments_[i] : gate.segment(i - size(), end(), start);
    const auto stretches = segment.stretches();
    for (std::size_t k = 0; k < stretches.size(); ++k) {
      const double stretch_end = start + (k + 1 < stretches.size() ? stretches[k + 1].begin : segment.length());
      if (stretches[k].last_of_move && stretch_end > s + kSamePlace) return stretch_end;
    }
  }
}

void LaidPath::travelled(double s, double needed_from) {
  if (segments_.empty()) return;
  for (std::size_t i = view().find(counted_s_, -1); i < size() && starts_[i] <= s; ++i) {
    const std::size_t done =
        segments_[i]->moves_ended(counted_s_ + kSamePlace - starts_[i], s + kSamePlace - starts_[i]);
    moves_left_ -= std::min(moves_left_, done);
  }
  counted_s_ = std::max(counted_s_, s);

  const std::size_t behind = view().find(std::min(s, needed_from) - kSamePlace, -1);
  if (behind < 2 * kKeptBehind) return;
  const auto n = static_cast<std::ptrdiff_t>(behind - kKeptBehind);
  segments_.erase(segments_.begin(), segments_.begin() + n);
  starts_.erase(starts_.begin(), starts_.begin() + n);
  rest_after_.erase(rest_after_.begin(), rest_after_.begin() + n);
}

void LaidPath::move_origin(double distance_mm) {
  for (double& start : starts_) start -= distance_mm;
  origin_ -= distance_mm;
  counted_s_ -= distance_mm;
}

std::optional<PathPlace> LaidPath::place_at(double s) const {
  if (segments_.empty()) return std::nullopt;
  // A path that ends within a move, as before a collision, has its place there.
  const bool at_end = s + kSamePlace >= end();
  if (at_end && (s > end() + kSamePlace || segments_.back()->stretches().back().last_of_move)) return std::nullopt;
  const std::size_t i = at_end ? segments_.size() - 1 : view().find(s + kSamePlace, 1);
  const double on_segment = std::max(s - starts_[i], 0.0);
  const MoveStretch& stretch = segments_[i]->stretch_at(on_segment + kSamePlace);
  JointPoint point;
  if (segments_[i]->evaluate(on_segment, 0, at_end ? -1 : 1, point) != KinematicsStatus::Ok) return std::nullopt;
  return PathPlace{stretch.move_id,
                   stretch.s_begin_mm + stretch.s_per_length * std::max(on_segment - stretch.begin, 0.0),
                   segments_[i]->pose(on_segment),
                   {point.d[0].begin(), point.d[0].begin() + static_cast<std::ptrdiff_t>(segments_[i]->joint_count())}};
}

LaidPath LaidPath::backward(double s, double distance) const {
  LaidPath back(joints_, period_s_);
  if (segments_.empty() || !(s > starts_.front())) return back;
  const double from = std::max(s - distance, starts_.front());
  back.origin_ = from;
  for (std::size_t i = view().find(s, -1) + 1; i-- > 0 && end(i) > from;) {
    const double begin = std::max(from - starts_[i], 0.0);
    const double end = std::min(s - starts_[i], segments_[i]->length());
    if (end - begin > kSamePlace) back.append(part_of(*segments_[i], begin, end, Direction::Backward));
  }
  return back;
}

LaidPath LaidPath::place(double s) const {
  LaidPath nothing(joints_, period_s_);
  nothing.origin_ = s;
  return nothing;
}

void LaidPath::lead_in(const PathSegments& away) {
  double begin = origin_;
  for (const auto& segment : away) begin -= segment->length();
  LaidPath way = place(begin);
  for (auto segment = away.rbegin(); segment != away.rend(); ++segment) {
    way.append(part_of(**segment, 0, (*segment)->length(), Direction::Backward));
  }
  way.lay(segments_);
  *this = std::move(way);
}

const PoseToJoints* LaidPath::map_at(double s) const {
  return segments_.empty() ? nullptr : segments_[view().find(s + kSamePlace, 1)]->map().get();
}

}  // namespace rmac
