#include "gateway/simulation/motion_account.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "rmac/motion/move_name.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::gateway {
namespace {

constexpr std::array kQuantities{"velocity", "acceleration", "jerk"};

/// The tool tip's way along a segment. One in joint space has the joints' length, so the tip's is that of chords.
double tip_length(const PathSegment& segment) {
  if (!segment.curve().in_joint_space()) return segment.length();
  constexpr int kChords = 1000;
  double length = 0;
  Vector from = segment.pose(0).tip;
  for (int i = 1; i <= kChords; ++i) {
    const Vector to = segment.pose(segment.length() * i / kChords).tip;
    length += distance(from, to);
    from = to;
  }
  return length;
}

/// `value` as part of its bound; nothing when there is none.
double part(double value, double bound) {
  return bound > 0 ? std::abs(value) / bound : 0;
}

}  // namespace

MotionAccount::MotionAccount(double period_s)
    : period_s_(period_s), time_s_(kJointLimits), time_in_move_s_(kJointLimits) {}

void MotionAccount::mechanism(const sdk::DeviceObject& device) {
  max_feed_mm_s_ = device.max_feedrate_mm_min / 60;
  bounds_.clear();
  for (const sdk::Joint& joint : device.joints) {
    const JointLimits& limits = joint.limits;
    const auto known = std::ranges::find(joints_, limits.name, &Joint::name);
    bounds_.push_back({static_cast<std::size_t>(known - joints_.begin()), limits.max_speed, limits.max_acceleration,
                       limits.max_jerk});
    if (known == joints_.end()) joints_.push_back({limits.name});
  }
  time_s_.resize(kJointLimits + kQuantities.size() * joints_.size());
  time_in_move_s_.assign(time_s_.size(), 0);
  acceleration_.assign(bounds_.size(), 0);
  jerk_.assign(bounds_.size(), 0);
  path_.clear();
  feed_before_mm_s_ = 0;
}

void MotionAccount::queued(const Move& move, std::span<const std::shared_ptr<const PathSegment>> segments) {
  PathBounds bounds;
  for (const auto& segment : segments) {
    // A jog is no part of the program's way, and may end before the end of its curve.
    if (move.id != kPositioningMoveId) length_mm_ += tip_length(*segment);
    if (segment->curve().in_joint_space()) {
      bounds.joint_fraction = move.joint_speed_fraction;
    } else {
      bounds.feed_mm_s = move.feed_mm_s;
    }
  }
  bounds.rise_mm_s2 = move.accel_rise_mm_s2;
  bounds.fall_mm_s2 = move.accel_fall_mm_s2;
  path_.push_back(bounds);
}

std::string MotionAccount::move_done() {
  if (!path_.empty()) path_.pop_front();
  const auto longest = std::ranges::max_element(time_in_move_s_);
  std::string ruled = *longest > 0 ? limit_name(static_cast<std::size_t>(longest - time_in_move_s_.begin())) : "";
  std::ranges::fill(time_in_move_s_, 0);
  return ruled;
}

void MotionAccount::cycle(const CycleSample& sample, double override_percent) {
  const std::size_t joints = std::min<std::size_t>(sample.joint_count, bounds_.size());
  for (std::size_t i = 0; i < joints; ++i) {
    jerk_[i] = (sample.acceleration_set[i] - acceleration_[i]) / period_s_;
    acceleration_[i] = sample.acceleration_set[i];
    Joint& joint = joints_[bounds_[i].joint];
    joint.peak_velocity = std::max(joint.peak_velocity, std::abs(sample.velocity_set[i]));
    joint.peak_acceleration = std::max(joint.peak_acceleration, std::abs(sample.acceleration_set[i]));
    joint.peak_jerk = std::max(joint.peak_jerk, std::abs(jerk_[i]));
  }
  rules_.reset();
  if (sample.moving) count(sample, override_percent);
  feed_before_mm_s_ = sample.feed_set_mm_s;
}

double MotionAccount::part_of_feed(const CycleSample& sample, const PathBounds& path, double override_factor) const {
  if (path.joint_fraction == 0) {
    return part(sample.feed_set_mm_s, std::min(path.feed_mm_s * override_factor, max_feed_mm_s_));
  }
  // What the client asked for, as long as it is less than the joints can.
  const double fraction = path.joint_fraction * override_factor;
  if (fraction >= 1) return 0;
  double largest = 0;
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    largest = std::max(largest, part(sample.velocity_set[i], bounds_[i].velocity * fraction));
  }
  return largest;
}

void MotionAccount::count(const CycleSample& sample, double override_percent) {
  const PathBounds path = path_.empty() ? PathBounds{} : path_.front();
  const double gain = (sample.feed_set_mm_s - feed_before_mm_s_) / period_s_;
  std::size_t nearest = kFeed;
  double largest = part_of_feed(sample, path, override_percent / 100);
  const auto consider = [&](std::size_t limit, double share) {
    if (share <= largest) return;
    largest = share;
    nearest = limit;
  };
  consider(kPathAcceleration, part(gain, gain > 0 ? path.rise_mm_s2 : path.fall_mm_s2));
  for (std::size_t i = 0; i < std::min<std::size_t>(sample.joint_count, bounds_.size()); ++i) {
    const Bounds& bounds = bounds_[i];
    const std::size_t first = kJointLimits + kQuantities.size() * bounds.joint;
    consider(first, part(sample.velocity_set[i], bounds.velocity));
    consider(first + 1, part(sample.acceleration_set[i], bounds.acceleration));
    consider(first + 2, part(jerk_[i], bounds.jerk));
  }
  const std::size_t rules = largest >= kRules ? nearest : kNone;
  time_s_[rules] += period_s_;
  time_in_move_s_[rules] += period_s_;
  rules_ = rules;
}

std::string MotionAccount::limit_name(std::size_t limit) const {
  constexpr std::array kOfPath{"none", "feed", "path acceleration"};
  if (limit < kOfPath.size()) return kOfPath[limit];
  const std::size_t of_joints = limit - kJointLimits;
  return fmt::format("{} {}", joints_[of_joints / kQuantities.size()].name,
                     kQuantities[of_joints % kQuantities.size()]);
}

std::vector<MotionAccount::Share> MotionAccount::shares() const {
  std::vector<Share> shares;
  for (std::size_t limit = kFeed; limit < time_s_.size(); ++limit)
    shares.push_back({limit_name(limit), time_s_[limit]});
  shares.push_back({limit_name(kNone), time_s_[kNone]});
  std::erase_if(shares, [](const Share& share) { return share.time_s == 0; });
  std::ranges::stable_sort(shares, std::ranges::greater{}, &Share::time_s);
  return shares;
}

}  // namespace rmac::gateway
