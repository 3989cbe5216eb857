#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <string>
#include <vector>

#include "gateway/collision/distance/gjk.hpp"
#include "gateway/collision/finding.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// What was found, one finding for each time that two bodies come together.
class FindingList {
 public:
  static constexpr std::size_t kMost = 1000;  ///< near ones; twice as many with those that meet

  struct Meeting {
    bool possible = false;  ///< nobody knows whether the stock is still there
    bool meet = false;      ///< or are only near
  };

  explicit FindingList(const Frame& part_frame);

  /// The finding of two bodies that was not over at `since_s`, or began in the same move, as the pieces of one body
  /// have it; or a new one. Null where there are too many. It stays where it is.
  [[nodiscard]] Finding* of(const std::string& first, const std::string& second, double since_s, const MoveNow& move,
                            const Meeting& meeting);
  /// How the two bodies stand to each other; `depth_mm` where they meet.
  void see(Finding& finding, const Apart& apart, double depth_mm, double t_s, const MoveNow& move);

  /// In the order in which they began.
  [[nodiscard]] std::vector<Finding> sorted() const;
  [[nodiscard]] std::size_t left_off() const noexcept { return left_off_; }
  /// A body met another, certainly.
  [[nodiscard]] bool collided() const noexcept { return collided_; }

 private:
  Eigen::Isometry3d to_part_;
  std::deque<Finding> findings_;
  std::size_t left_off_ = 0;
  bool collided_ = false;
};

}  // namespace rmac::gateway
