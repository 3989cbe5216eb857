#include "gateway/rmac/view/drawn_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "gateway/bodies/link.hpp"
#include "gateway/bodies/meshes/mesh_file.hpp"
#include "gateway/rmac/view/rounded.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::cli {
namespace {

using gateway::Body;
using gateway::BoxShape;
using gateway::ConeShape;
using gateway::MeshShape;
using gateway::SphereShape;
using gateway::TriangleMesh;
using Json = nlohmann::json;

constexpr std::size_t kFewestTriangles = 500;  ///< that any mesh may have
constexpr int kPerQuarter = 8;                 ///< pieces of a rounded outline

Json point(double radius, double height) {
  return rounded(std::vector{radius, height}, kPlaceDigits);
}

Json outline(const ConeShape& cone, double from) {
  Json list = Json::array({point(0, from), point(cone.bottom_radius, from)});
  list.push_back(point(cone.top_radius, from + cone.height));
  list.push_back(point(0, from + cone.height));
  return list;
}

/// A quarter of a circle from straight below its middle to beside it, or to above it where there are two.
void add_arc(Json& list, double middle_r, double middle_z, double radius, int quarters) {
  for (int i = 0; i <= kPerQuarter * quarters; ++i) {
    const double angle = std::numbers::pi / 2 * i / kPerQuarter;
    list.push_back(point(middle_r + radius * std::sin(angle), middle_z - radius * std::cos(angle)));
  }
}

Json outline(const SphereShape& sphere) {
  Json list = Json::array();
  add_arc(list, 0, 0, sphere.radius, 2);
  return list;
}

/// An end mill from its tip to the end of its flutes.
Json outline_of_cutter(const gateway::ToolShape& shape) {
  const double radius = shape.dc / 2, corner = std::min(shape.re, radius);
  Json list = Json::array({point(0, 0)});  // braces alone are a copy to clang++, an array to g++
  add_arc(list, radius - corner, corner, corner, 1);
  list.push_back(point(radius, std::max(shape.lcf, corner)));
  list.push_back(point(0, std::max(shape.lcf, corner)));
  return list;
}

/// The ball about a mesh's box, in its own frame.
Reach reach_of(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vector& p : mesh.points) box.extend(Eigen::Vector3d(p[0], p[1], p[2]));
  return {box.center(), box.diagonal().norm() / 2};
}

class Drawing {
 public:
  explicit Drawing(std::size_t most_triangles) : most_triangles_(most_triangles) {}

  Result<> read(const Body& body) {
    const auto* const shape = std::get_if<MeshShape>(&body.shape);
    if (shape == nullptr) return {};
    auto mesh = gateway::read_mesh_file(*shape);
    if (!mesh) return fail(fmt::format("body \"{}\": {}", body.name, mesh.error().message));
    triangles_ += mesh->triangles.size();
    meshes_.emplace(&body, std::move(*mesh));
    return {};
  }

  void draw(const Body& body, const char* kind, std::size_t link, const Frame& frame) {
    const Frame at = compose(frame, body.pose);
    Json json{{"name", body.name},
              {"kind", kind},
              {"link", link},
              {"p", rounded(at.p, kPlaceDigits)},
              {"q", rounded(at.q, kTurnDigits)}};
    if (!body.colour.empty()) json["colour"] = body.colour;
    Reach reach;
    if (const auto* box = std::get_if<BoxShape>(&body.shape)) {
      json["box"] = rounded(box->size, kPlaceDigits);
      reach.radius = std::hypot(box->size[0], box->size[1], box->size[2]) / 2;
    } else if (const auto* sphere = std::get_if<SphereShape>(&body.shape)) {
      json["turned"] = outline(*sphere);
      reach.radius = sphere->radius;
    } else if (const auto* cone = std::get_if<ConeShape>(&body.shape)) {
      json["turned"] = outline(*cone, -cone->height / 2);
      reach.radius = std::hypot(std::max(cone->bottom_radius, cone->top_radius), cone->height / 2);
    } else {
      const TriangleMesh mesh = coarse(std::move(meshes_.at(&body)));
      reach = reach_of(mesh);
      json["mesh"] = drawn_mesh(mesh);
    }
    const Vector middle = apply_to_point(at, {reach.middle[0], reach.middle[1], reach.middle[2]});
    reach.middle = {middle[0], middle[1], middle[2]};
    drawn_.bodies.push_back({std::move(json), link, reach});
  }

  DrawnBodies take() { return std::move(drawn_); }

 private:
  /// With its share of the triangles that there may be.
  TriangleMesh coarse(TriangleMesh mesh) {
    if (triangles_ <= most_triangles_) return mesh;
    const double part = static_cast<double>(mesh.triangles.size()) / static_cast<double>(triangles_);
    const auto share =
        std::max(static_cast<std::size_t>(part * static_cast<double>(most_triangles_)), kFewestTriangles);
    constexpr double kFirstPart = 1e-3, kCoarser = 1.5;
    constexpr std::size_t kFewestOfSolid = 4;
    double moved = 0;
    for (double apart = kFirstPart * reach_of(mesh).radius; mesh.triangles.size() > share; apart *= kCoarser) {
      TriangleMesh fewer = gateway::welded(mesh, apart);
      if (fewer.triangles.size() < kFewestOfSolid) break;
      mesh = std::move(fewer);
      moved += apart;
    }
    drawn_.coarser_mm = std::max(drawn_.coarser_mm, moved);
    return mesh;
  }

  std::size_t most_triangles_, triangles_ = 0;
  std::map<const Body*, TriangleMesh> meshes_;
  DrawnBodies drawn_;
};

}  // namespace

Json drawn_mesh(const TriangleMesh& mesh) {
  Json points = Json::array(), triangles = Json::array();
  for (const Vector& p : mesh.points) {
    for (const double c : p) points.push_back(rounded(c, kPlaceDigits));
  }
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) triangles.push_back(corner);
  }
  return {{"points", std::move(points)}, {"triangles", std::move(triangles)}};
}

Result<DrawnBodies> drawn_bodies(const gateway::MachineBodies& machine, const gateway::Setup* setup,
                                 std::size_t most_triangles) {
  struct OnTable {
    const Body* body;
    const char* kind;
  };
  std::vector<OnTable> on_table;
  if (setup != nullptr) {
    for (const Body& fixture : setup->fixtures) on_table.push_back({&fixture, "fixture"});
    if (setup->stock) on_table.push_back({&*setup->stock, "stock"});
    if (setup->part) on_table.push_back({&*setup->part, "part"});
  }
  Drawing drawing(most_triangles);
  for (const Body& body : machine.bodies) {
    if (auto read = drawing.read(body); !read) return tl::unexpected(read.error());
  }
  for (const auto& [body, kind] : on_table) {
    if (auto read = drawing.read(*body); !read) return tl::unexpected(read.error());
  }
  for (const Body& body : machine.bodies) {
    drawing.draw(body, "machine", gateway::link_number(machine.chain, body.link).value_or(0), Frame{});
  }
  for (const auto& [body, kind] : on_table) drawing.draw(*body, kind, 0, setup->part_frame);
  return drawing.take();
}

Json drawn_tool(const gateway::Tool& tool, const gateway::LinkChain& chain) {
  const Frame tip = compose(chain.interface_home(), tip_on_interface(tool));
  const std::string name = fmt::format("tool {}, ", tool.number);
  Json bodies = Json::array();
  const auto add = [&](const char* kind, Json outline) {
    bodies.push_back({{"name", name + kind},
                      {"kind", kind},
                      {"link", chain.link_count() - 1},
                      {"p", rounded(tip.p, kPlaceDigits)},
                      {"q", rounded(tip.q, kTurnDigits)},
                      {"turned", std::move(outline)}});
  };
  if (tool.shape) {
    add("cutting part", outline_of_cutter(*tool.shape));
    const auto sections = [&](const char* kind, const std::vector<ConeShape>& cones, double from) {
      for (const ConeShape& cone : cones) {
        add(kind, outline(cone, from));
        from += cone.height;
      }
    };
    sections("shank", tool.shape->shank, tool.shape->lcf);
    sections("holder", tool.shape->holder, tool.shape->holder_begins(tool.length_mm));
  }
  return {{"number", tool.number},
          {"name", tool.name},
          {"tip", rounded(tip.p, kPlaceDigits)},
          {"bodies", std::move(bodies)}};
}

}  // namespace rmac::cli
