#include "gateway/dynamics/path_deviation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rmac::gateway {
namespace {

constexpr std::size_t kKept = 4096;  ///< cycles, before old ones go

double distance2(const Eigen::Vector3d& point, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d way = to - from;
  const double length2 = way.squaredNorm();
  const double part = length2 > 0 ? std::clamp((point - from).dot(way) / length2, 0.0, 1.0) : 0;
  return (point - from - part * way).squaredNorm();
}

}  // namespace

void PathDeviation::add(const Cycle& cycle) {
  if (passed_.size() == kKept) {
    const std::size_t gone = judged_ - std::min(judged_, kBefore);
    passed_.erase(passed_.begin(), passed_.begin() + static_cast<std::ptrdiff_t>(gone));
    judged_ -= gone;
  }
  passed_.push_back(cycle);
  while (judged_ + kAfter < passed_.size()) judge(judged_++);
}

void PathDeviation::forget() {
  while (judged_ < passed_.size()) judge(judged_++);
  passed_.clear();
  judged_ = 0;
}

double PathDeviation::rms_mm() const noexcept {
  return count_ > 0 ? std::sqrt(sum_mm2_ / static_cast<double>(count_)) : 0;
}

void PathDeviation::judge(std::size_t at) {
  const Cycle& cycle = passed_[at];
  double least2 = std::numeric_limits<double>::infinity();
  const std::size_t first = at - std::min(at, kBefore), last = std::min(at + kAfter, passed_.size() - 1);
  for (std::size_t i = first; i <= last; ++i) {
    least2 = std::min(least2, distance2(cycle.truth, passed_[i > first ? i - 1 : i].planned, passed_[i].planned));
  }
  sum_mm2_ += least2;
  ++count_;
  const double off_mm = std::sqrt(least2);
  peak_mm_ = std::max(peak_mm_, off_mm);
  if (told_) told_(cycle.t_s, off_mm);
  if (allowed_mm_ <= 0 || off_mm <= allowed_mm_) return;
  // What is within so little for some cycles, and beyond it again, is one.
  const std::size_t recent = at - std::min(at, kAfter);
  const bool goes_on = !off_path_.empty() && off_path_.back().until_s >= passed_[recent].t_s;
  if (!goes_on) {
    if (off_path_.size() == kMostOffPath) return;
    off_path_.push_back({.line = cycle.line, .move_id = cycle.move_id, .t_s = cycle.t_s, .allowed_mm = allowed_mm_});
  }
  OffPath& last_one = off_path_.back();
  last_one.until_s = cycle.t_s;
  if (off_mm <= last_one.most_mm) return;
  last_one.most_mm = off_mm, last_one.most_t_s = cycle.t_s, last_one.place = cycle.place;
}

}  // namespace rmac::gateway
