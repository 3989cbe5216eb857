#pragma once

#include "servo/joints/index_set.hpp"

namespace rmac {

/// Which joints are under control: their drives operate, and what the loop makes of their setpoints counts.
class LiveJoints {
 public:
  [[nodiscard]] IndexSet all() const noexcept { return live_; }
  [[nodiscard]] bool operator[](std::size_t joint) const noexcept { return has(live_, joint); }
  /// Under control by another loop's handover: its law has still to be engaged.
  [[nodiscard]] bool handed(std::size_t joint) const noexcept { return has(handed_, joint); }

  void take(std::size_t joint) noexcept { live_ |= only(joint); }
  void take_over(IndexSet joints) noexcept { live_ = handed_ = joints; }
  /// Laws of all joints that were handed over are engaged.
  void engaged() noexcept { handed_ = 0; }
  void let_go(IndexSet joints) noexcept {
    live_ &= ~joints;
    handed_ &= ~joints;
  }

 private:
  IndexSet live_ = 0;
  IndexSet handed_ = 0;
};

}  // namespace rmac
