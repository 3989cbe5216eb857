#include "planner/before_gate.hpp"

#include <algorithm>
#include <utility>

#include "path/part_of.hpp"

namespace rmac {
namespace {

using Kind = PathGate::Answer::Kind;

/// A piece that is shorter is none.
constexpr double kShortestPiece = 1e-7;

}  // namespace

void BeforeGate::hand_over(PathSegments fresh) {
  for (auto& segment : fresh) {
    gate_->ask(segment);
    asked_.push_back({.segment = std::move(segment), .last = false});
  }
  if (!fresh.empty()) asked_.back().last = true;
}

std::size_t BeforeGate::passed(PathGate::Answer& next) {
  for (std::size_t i = 0; i < asked_.size(); ++i) {
    Asked& at = asked_[i];
    if (!at.passed) {
      next = gate_->answer();
      if (next.kind != Kind::Passes) return i;
      at.passed = true;
    }
    if (at.last) return i + 1;
  }
  return asked_.size();
}

void BeforeGate::take(PathSegments& out) {
  if (blocked_ || asked_.empty()) return;
  PathGate::Answer next{Kind::Passes, 0};
  const std::size_t count = passed(next);
  if (next.kind == Kind::Wait) {
    waits_ = true;
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Asked& at = asked_.front();
    out.push_back(at.given == 0 ? at.segment : part_of(*at.segment, at.given, at.segment->length()));
    asked_.pop_front();
  }
  if (next.kind == Kind::Passes) return;
  Asked& at = asked_.front();
  const double up_to = std::min(next.up_to, at.segment->length());
  const bool some = up_to - at.given > kShortestPiece;
  if (some) out.push_back(part_of(*at.segment, std::exchange(at.given, up_to), up_to));
  blocked_ = next.kind == Kind::Blocks;
  waits_ = waits_ || (!blocked_ && !some);
}

void BeforeGate::clear() {
  asked_.clear();
  blocked_ = waits_ = false;
  if (gate_ != nullptr) gate_->forget();
}

const PathSegment& BeforeGate::segment(std::size_t i, double end, double& start) const noexcept {
  start = end;
  for (std::size_t k = 0; k < i; ++k) start += asked_[k].segment->length() - asked_[k].given;
  start -= asked_[i].given;
  return *asked_[i].segment;
}

double BeforeGate::end(double end) const noexcept {
  for (const Asked& at : asked_) end += at.segment->length() - at.given;
  return end;
}

}  // namespace rmac
