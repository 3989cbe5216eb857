#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "gateway/bodies/triangle_mesh.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::gateway {

// Solids, each in a frame of its own. mm.

/// Centred on its frame.
struct BoxShape {
  Vector size{};
};
/// Along z of its frame, its middle in the origin. Of a cylinder both radii are the same; a cone that ends in a point
/// has none at its top.
struct ConeShape {
  double bottom_radius = 0, top_radius = 0, height = 0;
};
struct SphereShape {
  double radius = 0;
};
/// A closed surface of triangles in a file, or here; coordinates times `unit_mm` are mm.
struct MeshShape {
  std::filesystem::path file;
  double unit_mm = 1;
  std::shared_ptr<const TriangleMesh> surface{};  ///< instead of the file; not yet looked at
};

using SolidShape = std::variant<BoxShape, ConeShape, SphereShape, MeshShape>;

/// One solid of a machine's link, or of what stands on its table.
struct Body {
  std::string name;
  std::string link;  ///< `base`, `table`, `spindle`, or a joint's name; of what stands on the table: empty
  SolidShape shape;
  /// Of a machine's: where it stands in the machine frame while all joints stand at 0. Of a set-up's: in the part
  /// frame.
  Frame pose;
  std::string colour;  ///< `#rrggbb`; empty: whatever suits who draws it
};

/// What is said of a machine's shape in its `device.json`.
struct MachineBodies {
  std::vector<std::string> chain;  ///< names of the joints from the table to the spindle, and `base` among them
  std::vector<Body> bodies;
};

}  // namespace rmac::gateway
