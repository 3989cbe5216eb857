#include "gateway/animation/drawing_json.hpp"

#include <nlohmann/json.hpp>

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

Json frame_json(const Frame& frame) {
  return {{"p", frame.p}, {"q", frame.q}};
}

struct ShapeJson {
  Json operator()(const BoxShape& box) const { return {{"Box", {{"Size", box.size}}}}; }
  Json operator()(const SphereShape& sphere) const { return {{"Sphere", {{"Radius", sphere.radius}}}}; }
  Json operator()(const ConeShape& cone) const {
    if (cone.bottom_radius == cone.top_radius) {
      return {{"Cylinder", {{"Radius", cone.bottom_radius}, {"Height", cone.height}}}};
    }
    return {{"Cone", {{"Radius", cone.bottom_radius}, {"TopRadius", cone.top_radius}, {"Height", cone.height}}}};
  }
  Json operator()(const MeshShape& mesh) const { return {{"Mesh", {{"File", mesh.file.filename().string()}}}}; }
};

}  // namespace

Json to_json(const MachineDrawing& drawing) {
  Json bodies = Json::array();
  for (const Body& body : drawing.bodies->bodies) {
    Json told{{"Name", body.name},
              {"Link", body.link},
              {"Shape", std::visit(ShapeJson{}, body.shape)},
              {"Pose", frame_json(body.pose)}};
    if (!body.colour.empty()) told["Colour"] = body.colour;
    bodies.push_back(std::move(told));
  }
  const auto& links = drawing.links;
  return {{"geometry", drawing.number},
          {"machine", drawing.machine.empty() ? Json() : Json(drawing.machine)},
          {"missing", drawing.missing},
          {"joints", drawing.joints},
          {"links", links ? links->names() : std::vector<std::string>()},
          {"interface", links ? frame_json(links->interface_home()) : Json()},
          {"bodies", std::move(bodies)}};
}

Json to_json(const TriangleMesh& mesh) {
  return {{"Points", mesh.points}, {"Triangles", mesh.triangles}};
}

}  // namespace rmac::gateway
