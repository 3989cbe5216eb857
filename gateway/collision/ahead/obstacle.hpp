#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace rmac::gateway {

/// What lies on the way: two bodies, and how they would come together.
struct Obstacle {
  std::string first{}, second{};  ///< none: the joints are not known there
  std::int64_t move_id = 0;
  double s_mm = 0;                 ///< along the move, to where it may go
  Eigen::Vector3d place{0, 0, 0};  ///< in the part frame: where they would first meet, or be nearest
  double depth_mm = 0;             ///< the deepest that was seen behind that; 0: they would only come too near
  double distance_mm = 0;          ///< at the end of the way that is clear
  bool at_begin = false;           ///< they meet where the machine stands already
};

/// For a person: what is on the way, and where the machine comes to rest.
[[nodiscard]] std::string described(const Obstacle& obstacle);

}  // namespace rmac::gateway
