#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "rmac/motion/curve.hpp"

namespace rmac {

/// Which way along a curve.
enum class Direction : std::uint8_t { Forward, Backward };

/// The part of a curve between two arc lengths, as a curve of its own, in its own direction or against it; with more
/// nodes than the curve has, where its own are not enough, and none hardly off an end.
class TrimmedCurve final : public Curve {
 public:
  TrimmedCurve(std::shared_ptr<const Curve> curve, double begin, double end, Direction direction = Direction::Forward,
               const std::vector<double>* more_nodes = nullptr)
      : curve_(std::move(curve)), begin_(begin), end_(end), direction_(direction) {
    const auto inside = [&](std::span<const double> all, std::vector<double>& kept) {
      const auto first = static_cast<std::ptrdiff_t>(kept.size());
      for (const double s : all) {
        if (s > begin_ && s < end_) kept.push_back(direction_ == Direction::Forward ? s - begin_ : end_ - s);
      }
      if (direction_ == Direction::Backward) std::reverse(kept.begin() + first, kept.end());
    };
    inside(curve_->breaks(), breaks_);
    nodes_.push_back(0);
    inside(curve_->nodes(), nodes_);
    if (more_nodes != nullptr) {
      inside(*more_nodes, nodes_);
      std::sort(nodes_.begin(), nodes_.end());
      nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
    }
    nodes_.push_back(end_ - begin_);
    drop_slivers();
  }
  [[nodiscard]] bool in_joint_space() const noexcept override { return curve_->in_joint_space(); }
  [[nodiscard]] std::size_t dimension() const noexcept override { return curve_->dimension(); }
  [[nodiscard]] double length() const noexcept override { return end_ - begin_; }
  [[nodiscard]] bool even() const noexcept override { return curve_->even(); }
  void evaluate(double s, int order, int side, CurvePoint& point) const noexcept override {
    // At its own ends only one side exists.
    if (s <= 0) side = 1;
    if (s >= end_ - begin_) side = -1;
    if (direction_ == Direction::Forward) {
      curve_->evaluate(std::clamp(begin_ + s, begin_, end_), order, side, point);
      return;
    }
    curve_->evaluate(std::clamp(end_ - s, begin_, end_), order, -side, point);
    for (std::size_t k = 1; k <= static_cast<std::size_t>(order); k += 2) {
      for (std::size_t c = 0; c < dimension(); ++c) point.d[k][c] = -point.d[k][c];
    }
  }
  [[nodiscard]] std::span<const double> breaks() const noexcept override { return breaks_; }
  [[nodiscard]] std::span<const double> nodes() const noexcept override { return nodes_; }

 private:
  /// Such a node adds nothing but a step that is far shorter than the one beside it.
  void drop_slivers() {
    constexpr double kPart = 0.2;
    const auto sliver = [&](std::size_t end, std::size_t next, std::size_t beyond) {
      return nodes_.size() > 3 &&
             std::abs(nodes_[next] - nodes_[end]) < kPart * std::abs(nodes_[beyond] - nodes_[next]);
    };
    while (sliver(0, 1, 2)) nodes_.erase(nodes_.begin() + 1);
    while (sliver(nodes_.size() - 1, nodes_.size() - 2, nodes_.size() - 3)) nodes_.erase(nodes_.end() - 2);
  }

  std::shared_ptr<const Curve> curve_;
  double begin_, end_;
  Direction direction_;
  std::vector<double> breaks_, nodes_;
};

}  // namespace rmac
