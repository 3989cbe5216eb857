#include "gateway/bodies/body_json.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <strings.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <system_error>

#include "gateway/bodies/link.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr double kInch_mm = 25.4;
constexpr double kFarthest_mm = 1e5;

tl::unexpected<Error> wrong(const std::string& pointer, const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, pointer + what);
}

bool same_but_for_case(const std::string& a, const std::string& b) {
  return strcasecmp(a.c_str(), b.c_str()) == 0;
}

/// The file of a mesh, which is where it seems to be: nobody reads other files of this computer by a body.
Expected<fs::path> mesh_file(const std::string& name, const std::string& pointer, const fs::path& folder) {
  const fs::path relative(name);
  const bool climbs = std::any_of(relative.begin(), relative.end(), [](const fs::path& part) { return part == ".."; });
  std::error_code code;
  const fs::path inside = fs::weakly_canonical(folder.empty() ? "." : folder, code);
  const fs::path file = code ? fs::path() : fs::weakly_canonical(inside / relative, code);
  const bool escapes = std::mismatch(inside.begin(), inside.end(), file.begin(), file.end()).first != inside.end();
  if (relative.is_absolute() || climbs || code || escapes) {
    return wrong(pointer,
                 fmt::format("/File is \"{}\"; allowed is a file in the folder {} or below it", name, folder.string()));
  }
  if (!fs::is_regular_file(file, code)) {
    return wrong(pointer, fmt::format("/File is \"{}\", and there is no such file in {}", name, folder.string()));
  }
  return file;
}

std::string unknown_link(const std::string& link, const std::vector<std::string>& chain) {
  std::vector<std::string> known{kTable, kSpindle};
  known.insert(known.end(), chain.begin(), chain.end());
  const auto meant =
      std::find_if(known.begin(), known.end(), [&](const auto& k) { return same_but_for_case(k, link); });
  return fmt::format("/Link is \"{}\", which is no link of this machine;{} there are {}", link,
                     meant == known.end() ? "" : fmt::format(" did you mean \"{}\"?", *meant), fmt::join(known, ", "));
}

/// What is wrong with the order of the links; empty: nothing.
std::string check_chain(const std::vector<std::string>& chain, std::span<const std::string> joints) {
  std::vector<std::string> wanted(joints.begin(), joints.end());
  for (const std::string& joint : wanted) {
    if (joint != kBase && joint != kTable && joint != kSpindle) continue;
    return fmt::format(
        "/Joints has one that is called \"{}\", which is the name of a link of every machine; call it "
        "something else",
        joint);
  }
  wanted.emplace_back(kBase);
  std::vector<std::string> given = chain;
  std::sort(wanted.begin(), wanted.end());
  std::sort(given.begin(), given.end());
  if (given == wanted) return {};
  return fmt::format("/Chain is {}; it must name base and each of the joints {} once, from the table to the spindle",
                     fmt::join(chain, " "), fmt::join(joints, ", "));
}

}  // namespace

Expected<Frame> read_frame(const Json& object, const std::string& pointer) {
  Frame frame;
  object.at("p").get_to(frame.p);
  if (object.contains("q") == object.contains("axis")) {
    return wrong(pointer, " must have either \"q\", a quaternion [w, x, y, z], or \"axis\", where z points");
  }
  if (object.contains("axis")) {
    const auto axis = object["axis"].get<Vector>();
    if (const double size = std::hypot(axis[0], axis[1], axis[2]); std::abs(size - 1) > 1e-6) {
      return wrong(pointer, fmt::format("/axis has length {}; it must be 1 (to 1e-6)", size));
    }
    return frame_from_axis(frame.p, axis);
  }
  object["q"].get_to(frame.q);
  if (auto fine = check_frame(frame, pointer); !fine) return tl::unexpected(fine.error());
  return normalized(frame);
}

namespace {

/// Three numbers that a mesh may have; none: it is something else.
template <typename T>
std::optional<std::array<T, 3>> three(const Json& entry, double least, double most) {
  if (!entry.is_array() || entry.size() != 3) return std::nullopt;
  std::array<T, 3> all{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Json& value = entry[i];
    const bool fits = std::is_integral_v<T> ? value.is_number_integer() : value.is_number();
    if (!fits || !(value.get<double>() >= least && value.get<double>() <= most)) return std::nullopt;
    all[i] = value.get<T>();
  }
  return all;
}

/// The triangles that stand in the document itself.
Expected<SolidShape> read_surface(const Json& shape, const std::string& pointer, double unit_mm) {
  if (!shape.contains("Points") || !shape.contains("Triangles")) {
    return wrong(pointer, " needs \"File\", or both \"Points\" and \"Triangles\"");
  }
  const Json &points = shape["Points"], &triangles = shape["Triangles"];
  TriangleMesh mesh;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto point = three<double>(points[i], -kFarthest_mm, kFarthest_mm);
    if (!point) {
      return wrong(pointer, fmt::format("/Points/{} is no place: three numbers of -{:g} to {:g}", i, kFarthest_mm,
                                        kFarthest_mm));
    }
    mesh.points.push_back(*point);
  }
  const double last = static_cast<double>(points.size()) - 1;
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const auto triangle = three<std::uint32_t>(triangles[i], 0, last);
    if (!triangle) {
      return wrong(pointer, fmt::format("/Triangles/{} is no triangle: three numbers of Points, 0 to {:.0f}", i, last));
    }
    mesh.triangles.push_back(*triangle);
  }
  return MeshShape{{}, unit_mm, std::make_shared<const TriangleMesh>(std::move(mesh))};
}

Expected<SolidShape> read_mesh_shape(const Json& shape, const std::string& pointer, const MeshFolder& folder) {
  const double unit_mm = shape.value("Unit", "mm") == "inch" ? kInch_mm : 1.0;
  if (!shape.contains("File")) return read_surface(shape, pointer, unit_mm);
  if (shape.contains("Points") || shape.contains("Triangles")) {
    return wrong(pointer, " has \"File\" and triangles of its own; give it one of both");
  }
  if (!folder) {
    return wrong(pointer,
                 "/File names a file, and none is read here; send the surface itself, as \"Points\" and "
                 "\"Triangles\"");
  }
  return mesh_file(shape.at("File").get<std::string>(), pointer, *folder).map([&](const fs::path& file) -> SolidShape {
    return MeshShape{file, unit_mm};
  });
}

}  // namespace

Expected<SolidShape> read_shape(const Json& object, const std::string& pointer, const MeshFolder& folder) {
  if (object.size() != 1) {
    return wrong(pointer,
                 fmt::format(" has {} shapes; it must have one: Box, Cylinder, Cone, Sphere or Mesh", object.size()));
  }
  const std::string& kind = object.begin().key();
  const Json& shape = object.begin().value();
  if (kind == "Box") return BoxShape{shape.at("Size").get<Vector>()};
  if (kind == "Sphere") return SphereShape{shape.at("Radius").get<double>()};
  if (kind == "Cylinder") {
    const double radius = shape.at("Radius").get<double>();
    return ConeShape{radius, radius, shape.at("Height").get<double>()};
  }
  if (kind == "Cone") {
    return ConeShape{shape.at("Radius").get<double>(), shape.value("TopRadius", 0.0), shape.at("Height").get<double>()};
  }
  return read_mesh_shape(shape, pointer + "/Mesh", folder);
}

Expected<Body> read_body(const Json& object, const std::string& pointer, const MeshFolder& folder) {
  Body body;
  body.name = object.value("Name", "");
  body.link = object.value("Link", "");
  body.colour = object.value("Colour", "");
  auto shape = read_shape(object.at("Shape"), pointer + "/Shape", folder);
  if (!shape) return tl::unexpected(shape.error());
  body.shape = std::move(*shape);
  if (object.contains("Pose")) {
    auto pose = read_frame(object["Pose"], pointer + "/Pose");
    if (!pose) return tl::unexpected(pose.error());
    body.pose = *pose;
  }
  return body;
}

Expected<MachineBodies> read_machine_bodies(const Json& device_json, std::span<const std::string> joints,
                                            const fs::path& folder) {
  MachineBodies machine;
  machine.chain = device_json.value("Chain", std::vector<std::string>());
  const Json list = device_json.value("Geometry", Json::array());
  if (machine.chain.empty() && list.empty()) return machine;
  if (machine.chain.empty()) {
    return wrong("",
                 "/Geometry needs the key \"Chain\": base and the joints in the order from the table to the spindle");
  }
  if (std::string problem = check_chain(machine.chain, joints); !problem.empty()) return wrong("", problem);
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::string pointer = fmt::format("/Geometry/{}", i);
    auto body = read_body(list[i], pointer, folder);
    if (!body) return tl::unexpected(body.error());
    if (!link_number(machine.chain, body->link)) return wrong(pointer, unknown_link(body->link, machine.chain));
    const bool twice = std::any_of(machine.bodies.begin(), machine.bodies.end(),
                                   [&](const Body& other) { return other.name == body->name; });
    if (twice)
      return wrong(pointer, fmt::format("/Name is \"{}\", which another body has; give it its own", body->name));
    machine.bodies.push_back(std::move(*body));
  }
  return machine;
}

}  // namespace rmac::gateway
