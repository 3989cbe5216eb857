#pragma once

#include <cstdint>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::sdk {

/// An arc from where the queue ends, about an axis, counter-clockwise seen against `normal`.
struct ArcTo {
  Vector end{}, center{}, normal{};
};

/// The moves of Appendix IV's CMM part (5.2.3): they are queued as any, go from rest to rest, and bring a speed of
/// their own, in mm/s or degrees/s. Gateway thread only.
class CmmMoves {
 public:
  virtual ~CmmMoves() = default;

  /// The tip goes straight to a point; the tool axis stays as it is.
  virtual Expected<> to_point(std::int64_t id, const Vector& point, double speed) = 0;
  /// Likewise on an arc.
  virtual Expected<> in_arc(std::int64_t id, const ArcTo& arc, double speed) = 0;
  /// All joints together; `speed` is that of the linear ones together, or of all where there is none.
  virtual Expected<> all_joints(std::int64_t id, std::vector<double> joints, double speed) = 0;
  /// One rotary joint, to a position or whole turns from it: `direction` is the sense of turning, 0 the shortest way.
  virtual Expected<> rotary_joint(std::int64_t id, int joint, double position, int direction, double speed) = 0;
};

}  // namespace rmac::sdk
