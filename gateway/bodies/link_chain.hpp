#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/limits.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

/// Where each link of a machine stands, by the machine's own kinematics module: how each joint moves the tool is asked
/// of its forward kinematics at 0, and `chain` says in which order the joints carry each other, which a module does not
/// tell. The product of exponentials that they make is held against the module at other joint positions.
class LinkChain {
 public:
  /// `chain`: names from the table to the spindle, with `base`; `names` of the joints as the module counts them;
  /// `limits` low and high of each, within which the two are compared. Refused where they disagree: the order is not
  /// the machine's, or it is no chain.
  [[nodiscard]] static Expected<LinkChain> make(const Kinematics& kinematics, std::span<const std::string> chain,
                                                std::span<const std::string> names,
                                                std::span<const std::pair<double, double>> limits);

  /// The same of joints as the module counts them: within their limits, and where one has no end, within 400 mm or
  /// degrees.
  [[nodiscard]] static Expected<LinkChain> make(const Kinematics& kinematics, std::span<const std::string> chain,
                                                std::span<const JointLimits> joints);

  /// Links, by `link_number`.
  [[nodiscard]] std::size_t link_count() const noexcept { return order_.size() + 1; }
  /// The joint between link k and link k + 1, as the module counts it.
  [[nodiscard]] std::size_t joint_behind(std::size_t link) const noexcept { return order_[link]; }

  /// Where the tool interface stands while all joints stand at 0.
  [[nodiscard]] const Frame& interface_home() const noexcept { return interface_home_; }

  /// How each link is moved from where it stands at 0, in the machine frame, which is the table's. `frames`:
  /// link_count().
  void displace(std::span<const double> joints, std::span<Frame> frames) const noexcept;

  /// How fast a joint moves what it carries: a slide by `slides` mm a unit, and a turn by `turns` radians about its
  /// line.
  struct Motion {
    double slides = 0, turns = 0;  ///< per mm or degree of the joint
    Vector direction{0, 0, 1};     ///< of the turn, in the machine frame with all joints at 0
    Vector point{};                ///< on its line
  };
  [[nodiscard]] const Motion& motion(std::size_t joint) const noexcept { return motions_[joint]; }

 private:
  /// A screw: what one unit of the joint does, as the exponential of it.
  struct Screw {
    Vector turn{};   ///< rad
    Vector slide{};  ///< mm, of the origin
  };
  [[nodiscard]] static Frame moved_by(const Screw& screw, double amount) noexcept;

  Frame interface_home_;
  std::vector<std::size_t> order_;  ///< joints from the table to the spindle
  std::vector<Screw> screws_;       ///< of each joint
  std::vector<Motion> motions_;
};

}  // namespace rmac::gateway
