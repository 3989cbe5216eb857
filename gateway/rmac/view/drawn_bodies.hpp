#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <vector>

#include "gateway/bodies/body.hpp"
#include "gateway/bodies/link_chain.hpp"
#include "gateway/bodies/triangle_mesh.hpp"
#include "gateway/collision/setup/setup.hpp"
#include "gateway/rmac/view/link_tracks.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "gateway/tools/tool.hpp"

namespace rmac::cli {

/// Of all meshes of a page: 15 MB of it.
inline constexpr std::size_t kMostTriangles = 300'000;

/// A body as the page draws it: `name`, `kind`, `link`, `p` and `q` in the machine frame with all joints at 0, `colour`
/// where it has its own, and `box` (its size), `turned` (radius and height of the outline that turns about z) or
/// `mesh`.
struct DrawnBody {
  nlohmann::json json;
  std::size_t link = 0;
  Reach reach;
};

/// The bodies of a machine, and those of a set-up, which may be null. Meshes have no more triangles together than
/// these, unless they are many and small; where they would have more they are made coarser.
struct DrawnBodies {
  std::vector<DrawnBody> bodies;
  double coarser_mm = 0;  ///< by how much points of some mesh were moved at most; 0: none was
};
[[nodiscard]] Result<DrawnBodies> drawn_bodies(const gateway::MachineBodies& machine, const gateway::Setup* setup,
                                               std::size_t most_triangles = kMostTriangles);

/// What is in the spindle: `number`, `name`, `tip` (machine frame, all joints at 0) and its `bodies`, named as the
/// collision check names them; none of them for a tool without a shape.
[[nodiscard]] nlohmann::json drawn_tool(const gateway::Tool& tool, const gateway::LinkChain& chain);

/// `points` and `triangles`, each a list of three after three.
[[nodiscard]] nlohmann::json drawn_mesh(const gateway::TriangleMesh& mesh);

}  // namespace rmac::cli
