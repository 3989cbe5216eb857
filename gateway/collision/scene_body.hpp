#pragma once

#include <cstddef>
#include <string>

#include "gateway/collision/distance/solid.hpp"

namespace rmac::gateway {

/// One solid on one link. Several may have one name: a holder of cones.
struct SceneBody {
  enum class Kind {
    Machine,
    Fixture,
    Stock,
    Part,
    Cutter,      ///< what of a tool may be in material while it cuts
    CutterCore,  ///< the same, smaller: where it is in the part, too much is cut
    Shank,
    Holder
  };
  Kind kind = Kind::Machine;
  std::string name;
  std::size_t link = 0;
  Solid solid;
  Eigen::Isometry3d home;  ///< in the machine frame, all joints at 0
  double below_mm = 0;     ///< of a core: how far below the true surface it is
};

[[nodiscard]] inline bool on_tool(SceneBody::Kind kind) noexcept {
  return kind >= SceneBody::Kind::Cutter;
}
[[nodiscard]] inline bool on_table(SceneBody::Kind kind) noexcept {
  return kind == SceneBody::Kind::Fixture || kind == SceneBody::Kind::Stock || kind == SceneBody::Kind::Part;
}

}  // namespace rmac::gateway
