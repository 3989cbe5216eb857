#pragma once

#include <optional>

namespace rmac {

/// How stiff what a joint touches is, with the joint's own mechanics before it: by how its force changes with its
/// position. N a mm, or N·m a degree. Real-time safe.
class ContactStiffness {
 public:
  explicit ContactStiffness(double period_s) noexcept;

  void forget() noexcept { *this = ContactStiffness(period_s_); }
  /// One cycle in contact.
  void step(double position, double force) noexcept;
  /// Nothing before the joint went far enough.
  [[nodiscard]] std::optional<double> value() const noexcept { return found_; }

 private:
  double period_s_;
  bool begun_ = false;
  double fast_position_ = 0, fast_force_ = 0, slow_position_ = 0, slow_force_ = 0;
  double way_squared_ = 0, way_force_ = 0;
  double touching_s_ = 0;
  std::optional<double> found_;
};

}  // namespace rmac
