#include "gateway/collision/scene.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "gateway/bodies/isometry.hpp"
#include "gateway/bodies/link.hpp"
#include "gateway/bodies/meshes/mesh_file.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using Kind = SceneBody::Kind;

Expected<Solid> solid_of(const SolidShape& shape) {
  if (const auto* box = std::get_if<BoxShape>(&shape)) {
    return Solid(Convex::box(Vector3d(box->size[0], box->size[1], box->size[2]) / 2));
  }
  if (const auto* sphere = std::get_if<SphereShape>(&shape)) return Solid(Convex::sphere(sphere->radius));
  if (const auto* cone = std::get_if<ConeShape>(&shape)) {
    return Solid(Convex::cone(cone->bottom_radius, cone->top_radius, cone->height / 2));
  }
  return read_mesh_file(std::get<MeshShape>(shape)).map([](const TriangleMesh& mesh) { return Solid(mesh); });
}

Expected<> add(const Body& body, Kind kind, std::size_t link, const Isometry3d& frame, std::vector<SceneBody>& scene) {
  auto solid = solid_of(body.shape);
  if (!solid) {
    return failure(solid.error().code, fmt::format("body \"{}\": {}", body.name, solid.error().message));
  }
  scene.push_back({kind, body.name, link, std::move(*solid), frame * to_isometry(body.pose)});
  return {};
}

/// Solids on the tool's axis, from its tip up.
class Stack {
 public:
  Stack(std::vector<SceneBody>& bodies, std::size_t link, const Isometry3d& tip)
      : bodies_(bodies), link_(link), tip_(tip) {}
  void add(Kind kind, const std::string& name, const Convex& convex, double middle_mm) {
    Isometry3d at = tip_;
    at.translate(Vector3d(0, 0, middle_mm));
    bodies_.push_back({kind, name, link_, Solid(convex), at});
  }
  void add(Kind kind, const std::string& name, const std::vector<ConeShape>& sections, double from_mm) {
    for (const ConeShape& s : sections) {
      add(kind, name, Convex::cone(s.bottom_radius, s.top_radius, s.height / 2), from_mm + s.height / 2);
      from_mm += s.height;
    }
  }
  /// An end mill of a radius with rounded corners: its lower edge a rounded disc, the rest a cylinder.
  void add_cutter(Kind kind, const std::string& name, double radius, double corner, double from_mm, double to_mm) {
    if (corner > 0) add(kind, name, Convex::cone(radius - corner, radius - corner, 0, corner), from_mm + corner);
    const double begin = from_mm + corner;
    if (to_mm > begin) add(kind, name, Convex::cone(radius, radius, (to_mm - begin) / 2), (begin + to_mm) / 2);
  }

 private:
  std::vector<SceneBody>& bodies_;
  std::size_t link_;
  Isometry3d tip_;
};

}  // namespace

Expected<std::vector<SceneBody>> scene_bodies(const MachineBodies& machine, const Setup& setup) {
  std::vector<SceneBody> scene;
  for (const Body& body : machine.bodies) {
    const std::size_t link = link_number(machine.chain, body.link).value_or(0);
    if (auto added = add(body, Kind::Machine, link, Isometry3d::Identity(), scene); !added)
      return tl::unexpected(added.error());
  }
  const Isometry3d part_frame = to_isometry(setup.part_frame);
  const auto on = [&](const Body& body, Kind kind) { return add(body, kind, 0, part_frame, scene); };
  for (const Body& fixture : setup.fixtures) {
    if (auto added = on(fixture, Kind::Fixture); !added) return tl::unexpected(added.error());
  }
  for (const auto& [body, kind] : {std::pair(&setup.stock, Kind::Stock), std::pair(&setup.part, Kind::Part)}) {
    if (!*body) continue;
    if (auto added = on(**body, kind); !added) return tl::unexpected(added.error());
  }
  if (setup.stock && setup.part) {
    const SceneBody &part = scene.back(), &stock = scene[scene.size() - 2];
    if (const double apart = distance(stock.solid, stock.home, part.solid, part.home, 0).most; apart > 0) {
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("the part lies {:.3f} mm beside the stock; give both the same unit and Pose", apart));
    }
  }
  return scene;
}

std::vector<SceneBody> tool_bodies(const Tool& tool, const LinkChain& chain, double clearance_mm) {
  std::vector<SceneBody> bodies;
  if (!tool.shape) return bodies;
  const ToolShape& shape = *tool.shape;
  Stack stack(bodies, chain.link_count() - 1, to_isometry(compose(chain.interface_home(), tip_on_interface(tool))));
  const std::string name = fmt::format("tool {}, ", tool.number), cutting = name + "cutting part";
  const double radius = shape.dc / 2;
  stack.add_cutter(Kind::Cutter, cutting, radius, std::min(shape.re, radius), 0, shape.lcf);
  // Of a tool that is no thicker than the clearance half is left: the thinnest one must not pass through the part.
  const double below = std::min({clearance_mm, radius / 2, shape.lcf / 2});
  const double corner = std::clamp(shape.re - below, 0.0, radius - below);
  stack.add_cutter(Kind::CutterCore, cutting, radius - below, corner, below, shape.lcf);
  for (SceneBody& body : bodies) {
    if (body.kind == Kind::CutterCore) body.below_mm = below;
  }
  stack.add(Kind::Shank, name + "shank", shape.shank, shape.lcf);
  stack.add(Kind::Holder, name + "holder", shape.holder, shape.holder_begins(tool.length_mm));
  return bodies;
}

}  // namespace rmac::gateway
