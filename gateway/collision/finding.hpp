#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace rmac::gateway {

/// Two bodies that met, or came nearer than the clearance.
struct Finding {
  std::string first, second;
  int line = 0;              ///< of the program, when it began
  std::int64_t move_id = 0;  ///< likewise
  double t_s = 0, until_s = 0;
  Eigen::Vector3d place{0, 0, 0};  ///< in the part frame: where they first met, or were nearest
  double depth_mm = 0;             ///< of a collision, the deepest there was; 0: they never met
  double distance_mm = -1;         ///< the least there was; below 0: nobody looked yet
  bool collision = false;
  std::string why{};      ///< of stock that a tool meets, as it is at that moment: what it may not do there
  bool possible = false;  ///< with stock that something was cut from before, which may not be there any more
};

/// What runs while the joints move.
struct MoveNow {
  std::int64_t id = 0;
  int line = 0;
  bool cutting = false;  ///< the tool may be in material
};

}  // namespace rmac::gateway
