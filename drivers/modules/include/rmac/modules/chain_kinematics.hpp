#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "rmac/modules/axis_turns.hpp"
#include "rmac/modules/screw_axis.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::modules {

/// A machine tool as a chain of up to three slides and two turns from the part to the tool, in any order: table-table,
/// head-head, one of each, or slides alone. The product of exponentials of its axes is the forward kinematics; the
/// inverse is closed: the turns from the tool axis, then the slides from the tip, which they move linearly
/// (docs/derivations/chain-kinematics.md). Fewer joints than a pose has freedoms reach fewer poses.
class ChainKinematics final : public Kinematics {
 public:
  static constexpr std::size_t kMostSlides = 3;
  static constexpr std::size_t kMostTurns = 2;

  /// Axes in the order of the joints; `order` has their numbers in the order of the chain, from the part to the tool;
  /// `interface` is where the tool interface stands with all joints at 0. `fault()` tells what is wrong with them.
  ChainKinematics(const std::vector<ScrewAxis>& axes, const std::vector<std::size_t>& order, const Frame& interface)
      : count_(axes.size()), interface_(interface) {
    std::copy(axes.begin(), axes.end(), axes_.begin());
    std::copy(order.begin(), order.end(), order_.begin());
    for (std::size_t k = 0; k < count_; ++k) {
      if (is_turn(order_[k])) turns_[turn_count_++] = order_[k];
    }
    if (count_ == kMostSlides && turn_count_ == 0) know_slides();
    if (turn_count_ == 2) two_turns_ = TwoTurns(axes_[turns_[0]].direction, axes_[turns_[1]].direction);
  }

  /// What a chain must be, or nullptr: at most three slides in independent directions, at most two turns that are not
  /// parallel.
  [[nodiscard]] static const char* fault(const std::vector<ScrewAxis>& axes) noexcept {
    std::vector<Vector> slides, turns;
    for (const ScrewAxis& axis : axes) {
      (axis.type == JointType::Rotary ? turns : slides).push_back(axis.direction);
    }
    constexpr double kIndependent = 1e-3;
    const auto parallel = [](const Vector& a, const Vector& b) { return length(cross(a, b)) < kIndependent; };
    if (slides.size() > kMostSlides) return "a chain has at most 3 slides";
    if (turns.size() > kMostTurns) return "a chain has at most 2 turns";
    if (turns.size() == 2 && parallel(turns[0], turns[1])) return "the two turns must not be parallel";
    const bool flat = (slides.size() == 2 && parallel(slides[0], slides[1])) ||
                      (slides.size() == 3 && std::abs(dot(slides[0], cross(slides[1], slides[2]))) < kIndependent);
    return flat ? "the slides must move in independent directions" : nullptr;
  }

  [[nodiscard]] std::size_t joint_count() const noexcept override { return count_; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override { return axes_[joint].type; }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    pose = home(tool);
    for (std::size_t k = count_; k-- > 0;) {
      const std::size_t j = order_[k];
      if (is_turn(j)) {
        const Turn turn(axes_[j], joints[j]);
        pose = {turn.location(pose.tip), turn.vector(pose.axis)};
      } else {
        pose.tip = plus(pose.tip, joints[j], axes_[j].direction);
      }
    }
  }

  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> joints) const noexcept override {
    const ToolPose start = home(tool);
    if (slides_alone_) {
      const Vector way = plus(pose.tip, -1, start.tip);
      for (std::size_t j = 0; j < kMostSlides; ++j) joints[j] = dot(dual_[j], way);
      const bool upright = length(plus(pose.axis, -1, start.axis)) <= kAxisSlack;
      return upright && std::isfinite(way[0] + way[1] + way[2]) ? KinematicsStatus::Ok : KinematicsStatus::OutOfReach;
    }
    std::array<TurnAngles, 2> found;
    const std::size_t branches = solve_turns(start.axis, pose.axis, found);
    if (branches == 0) return KinematicsStatus::OutOfReach;
    double way = turns_near(found[0], seed, joints);
    if (branches == 2) {
      std::array<double, kMost> other{};
      if (turns_near(found[1], seed, other) < way) {
        for (std::size_t t = 0; t < turn_count_; ++t) joints[turns_[t]] = other[turns_[t]];
      }
    }
    return fit_slides(start, pose.tip, joints) ? KinematicsStatus::Ok : KinematicsStatus::OutOfReach;
  }

  [[nodiscard]] bool pole(Vector& axis) const noexcept override {
    axis = axes_[turns_[0]].direction;
    return turn_count_ == 2;
  }

  [[nodiscard]] std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                      std::span<double> joints) const noexcept override {
    std::array<TurnAngles, 2> found;
    const ToolPose start = home(tool);
    const std::size_t branches = std::min(solve_turns(start.axis, pose.axis, found), joints.size() / count_);
    std::array<double, 2> way{};
    for (std::size_t b = 0; b < branches; ++b) {
      const auto solution = joints.subspan(b * count_, count_);
      way[b] = turns_near(found[b], seed, solution);
      if (!fit_slides(start, pose.tip, solution)) return 0;
    }
    if (branches == 2 && way[1] < way[0]) {
      std::swap_ranges(joints.begin(), joints.begin() + static_cast<std::ptrdiff_t>(count_),
                       joints.begin() + static_cast<std::ptrdiff_t>(count_));
    }
    return branches;
  }

  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    if (slides_alone_) {
      std::copy(slides_by_.begin(), slides_by_.end(), jacobian.begin());
      return;
    }
    std::array<Turn, kMostTurns> turns;
    for (std::size_t t = 0; t < turn_count_; ++t) turns[t] = Turn(axes_[turns_[t]], joints[turns_[t]]);
    ToolPose pose = home(tool);
    std::size_t before = turn_count_;  // turns nearer to the part than the joint at hand
    for (std::size_t k = count_; k-- > 0;) {
      const std::size_t j = order_[k];
      const ScrewAxis& axis = axes_[j];
      Vector tip_by = axis.direction, axis_by{};
      if (is_turn(j)) {
        const Turn& turn = turns[--before];
        pose = {turn.location(pose.tip), turn.vector(pose.axis)};
        const Vector arm = cross(axis.direction, plus(pose.tip, -1, axis.point));
        const Vector lean = cross(axis.direction, pose.axis);
        for (std::size_t c = 0; c < 3; ++c) tip_by[c] = arm[c] * kRadPerDegree, axis_by[c] = lean[c] * kRadPerDegree;
      } else {
        pose.tip = plus(pose.tip, joints[j], axis.direction);
      }
      for (std::size_t t = before; t-- > 0;) tip_by = turns[t].vector(tip_by), axis_by = turns[t].vector(axis_by);
      for (std::size_t c = 0; c < 3; ++c) {
        jacobian[c * count_ + j] = tip_by[c];
        jacobian[(3 + c) * count_ + j] = axis_by[c];
      }
    }
  }

  [[nodiscard]] bool constant_jacobian() const noexcept override { return turn_count_ == 0; }

 private:
  static constexpr std::size_t kMost = kMostSlides + kMostTurns;
  static constexpr double kReach_mm = 1e-6;  ///< how far a tip may lie off what fewer than three slides reach

  [[nodiscard]] bool is_turn(std::size_t joint) const noexcept { return axes_[joint].type == JointType::Rotary; }
  [[nodiscard]] ToolPose home(const Frame& tool) const noexcept {
    return {apply_to_point(interface_, tool.p), apply_to_vector(interface_, z_axis(tool))};
  }

  [[nodiscard]] std::size_t solve_turns(const Vector& from, const Vector& to,
                                        std::array<TurnAngles, 2>& found) const noexcept {
    if (turn_count_ == 2) return two_turns_.solve(from, to, found);
    if (turn_count_ == 1) return solve_turn(axes_[turns_[0]].direction, from, to, found);
    return length(plus(to, -1, from)) <= kAxisSlack ? 1 : 0;
  }

  /// Three slides alone need no orthogonalisation each time: the planner of a three-axis mill asks for little else than
  /// their inverse and Jacobian.
  void know_slides() noexcept {
    for (std::size_t j = 0; j < kMostSlides; ++j) {
      const Vector across = cross(axes_[(j + 1) % kMostSlides].direction, axes_[(j + 2) % kMostSlides].direction);
      const double share = dot(axes_[j].direction, across);
      for (std::size_t c = 0; c < 3; ++c) {
        dual_[j][c] = across[c] / share;
        slides_by_[c * kMostSlides + j] = axes_[j].direction[c];
      }
    }
    slides_alone_ = true;
  }

  /// Puts one solution's turns into `joints`, each by whole turns as near to the seed as it can be, a free one on it.
  /// The square of the way from the seed.
  double turns_near(const TurnAngles& found, std::span<const double> seed, std::span<double> joints) const noexcept {
    double way = 0;
    for (std::size_t t = 0; t < turn_count_; ++t) {
      const std::size_t j = turns_[t];
      const double degrees = found.angle[t] / kRadPerDegree;
      joints[j] = found.free[t] ? seed[j] : degrees + 360 * std::round((seed[j] - degrees) / 360);
      way += (joints[j] - seed[j]) * (joints[j] - seed[j]);
    }
    return way;
  }

  /// The slides that bring the tip to where it is wanted, with the turns in `joints` as they are: by orthogonalisation
  /// of the slides' directions, seen past the turns before them. False where no slides do.
  [[nodiscard]] bool fit_slides(ToolPose start, const Vector& tip, std::span<double> joints) const noexcept {
    std::array<Turn, kMostTurns> turns;
    for (std::size_t t = 0; t < turn_count_; ++t) turns[t] = Turn(axes_[turns_[t]], joints[turns_[t]]);
    for (std::size_t t = turn_count_; t-- > 0;) start.tip = turns[t].location(start.tip);
    Vector rest = plus(tip, -1, start.tip);
    std::array<Vector, kMostSlides> across;  // each slide's direction less what the ones before it do
    std::array<std::array<double, kMostSlides>, kMostSlides> share{};
    std::array<std::size_t, kMostSlides> slide{};
    std::array<double, kMostSlides> way{};
    std::size_t slides = 0, before = 0;
    for (std::size_t k = 0; k < count_; ++k) {
      const std::size_t j = order_[k];
      if (is_turn(j)) {
        ++before;
        continue;
      }
      Vector direction = axes_[j].direction;
      for (std::size_t t = before; t-- > 0;) direction = turns[t].vector(direction);
      for (std::size_t i = 0; i < slides; ++i) {
        share[i][slides] = dot(across[i], direction) / dot(across[i], across[i]);
        direction = plus(direction, -share[i][slides], across[i]);
      }
      across[slides] = direction;
      way[slides] = dot(direction, rest) / dot(direction, direction);
      rest = plus(rest, -way[slides], direction);
      slide[slides++] = j;
    }
    for (std::size_t i = slides; i-- > 0;) {
      for (std::size_t m = i + 1; m < slides; ++m) way[i] -= share[i][m] * way[m];
      joints[slide[i]] = way[i];
    }
    return slides == kMostSlides ? std::isfinite(way[0] + way[1] + way[2]) : length(rest) <= kReach_mm;
  }

  std::size_t count_;
  Frame interface_;
  std::array<ScrewAxis, kMost> axes_{};
  std::array<std::size_t, kMost> order_{};
  std::array<std::size_t, kMostTurns> turns_{};  ///< joints that turn, in the order of the chain
  std::size_t turn_count_ = 0;
  TwoTurns two_turns_;
  bool slides_alone_ = false;  ///< three slides and nothing else
  std::array<Vector, kMostSlides> dual_{};
  std::array<double, 6 * kMostSlides> slides_by_{};  ///< their Jacobian
};

/// Slides along the first `count` axes of the machine frame.
[[nodiscard]] inline ChainKinematics cartesian(std::size_t count) {
  std::vector<ScrewAxis> axes(count);
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) {
    axes[i].direction = {i == 0 ? 1.0 : 0.0, i == 1 ? 1.0 : 0.0, i == 2 ? 1.0 : 0.0};
    order[i] = i;
  }
  return ChainKinematics(axes, order, Frame{});
}

}  // namespace rmac::modules
