#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gateway/bodies/body.hpp"
#include "gateway/bodies/link_poses.hpp"

namespace rmac::gateway {

/// What can be drawn of one machine. Never changes once it is made.
struct MachineDrawing {
  std::int64_t number = 0;       ///< another one whenever another machine, or other kinematics, are in force
  std::int64_t after_cycle = 0;  ///< samples of later cycles are of this machine
  std::string machine;           ///< empty: none is loaded
  std::vector<std::string> joints;
  std::optional<LinkPoses> links;  ///< none: nothing is known of where they stand
  std::shared_ptr<const MachineBodies> bodies = std::make_shared<const MachineBodies>();
  std::string missing;  ///< what is not known, and why, for people; empty: nothing
};

/// What is known of the shape of the mechanism in force.
class ShapePort {
 public:
  virtual ~ShapePort() = default;
  /// The solids of the mechanism in force; none: nothing is known of its shape. While the mechanism may change.
  virtual void set_bodies(MachineBodies bodies) = 0;
  /// Made when it is asked for first. Any thread.
  [[nodiscard]] virtual std::shared_ptr<const MachineDrawing> drawing() const = 0;
};

}  // namespace rmac::gateway
