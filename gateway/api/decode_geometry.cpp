// Poses and curves of the wire, as spec/contract.md and docs/protocol.md describe them.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gateway/api/decode.hpp"

namespace rmac::gateway {

namespace {

using nlohmann::json;

constexpr std::size_t kLargestDegree = 25;  // what CAD kernels write (OpenCASCADE's limit)

template <std::size_t kSize>
Decoded<std::array<double, kSize>> numbers_at(const json& object, const char* key, const char* expected) {
  const json& value = object[key];
  if (!value.is_array() || value.size() != kSize ||
      !std::ranges::all_of(value, [](const json& item) { return item.is_number(); })) {
    return mismatch(value, expected, std::string(".") + key);
  }
  return value.get<std::array<double, kSize>>();
}

template <std::size_t kSize>
double norm_of(const std::array<double, kSize>& values) {
  double sum = 0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum);
}

Decoded<int> only_members(const json& value, std::initializer_list<const char*> known, const char* expected) {
  if (!value.is_object()) return mismatch(value, expected);
  for (const auto& item : value.items()) {
    const std::string& key = item.key();
    if (std::ranges::none_of(known, [&](const char* name) { return key == name; })) {
      return mismatch(item.value(), fmt::format("no such member; {}", expected), "." + key);
    }
  }
  return 0;
}

constexpr const char* kVectorExpected = "three numbers [x, y, z] in mm";

bool within(const Range& range, const json& numbers) {
  return std::ranges::all_of(numbers, [&](const json& number) { return range.contains(number.get<double>()); });
}

/// A place, once its form was found right: its numbers must lie in the parameter's range.
tl::unexpected<Mismatch> out_of_range(const json& value, const ParameterSpec& spec, std::string where = {}) {
  return mismatch(value, fmt::format("numbers {} {}", spec.range.text(), spec.unit), std::move(where));
}
constexpr const char* kFrameExpected = R"(a frame {"p": [x, y, z], "q": [w, x, y, z]})";
constexpr const char* kPoseExpected = R"(a frame {"p": [x, y, z]} with "q": [w, x, y, z] or "axis": [i, j, k])";

/// `q`, brought to exactly unit length. Off by more than 1e-3 it is a mistake rather than rounding.
Decoded<std::array<double, 4>> quaternion_of(const json& frame) {
  auto q = numbers_at<4>(frame, "q", "a unit quaternion [w, x, y, z]");
  if (!q) return q;
  const double norm = norm_of(*q);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    return mismatch(frame["q"], fmt::format("a unit quaternion [w, x, y, z]; the length of this one is {}", norm),
                    ".q");
  }
  for (double& value : *q) value /= norm;
  return q;
}

Decoded<Vector> axis_of(const json& frame) {
  auto axis = numbers_at<3>(frame, "axis", "a unit vector [i, j, k] from the tip to the spindle");
  if (!axis) return axis;
  const double norm = norm_of(*axis);
  if (!(std::abs(norm - 1) <= 1e-3)) {
    return mismatch(frame["axis"], fmt::format("a unit vector [i, j, k]; the length of this one is {}", norm), ".axis");
  }
  for (double& value : *axis) value /= norm;
  return axis;
}

/// The z axis of the frame, turned by q: the direction from the tool tip to the spindle.
Vector tool_axis(const std::array<double, 4>& q) {
  const auto [w, x, y, z] = q;
  return {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
}

constexpr const char* kNurbsMembers = R"({"degree", "knots", "points", "weights"} with flat knots or "multiplicities")";

Decoded<std::vector<double>> flat_knots(const json& value) {
  ParameterSpec any;
  Decoded<std::vector<double>> knots{std::vector<double>{}};
  decode_into(value["knots"], any, knots);
  if (!knots) {
    knots.error().where = ".knots" + knots.error().where;
    return knots;
  }
  if (!value.contains("multiplicities")) return knots;
  const json& multiplicities = value["multiplicities"];
  if (!multiplicities.is_array() || multiplicities.size() != knots->size()) {
    return mismatch(multiplicities, fmt::format("one integer for each of the {} knots", knots->size()),
                    ".multiplicities");
  }
  std::vector<double> flat;
  for (std::size_t i = 0; i < knots->size(); ++i) {
    const json& count = multiplicities[i];
    if (!count.is_number_unsigned() || count.get<std::uint64_t>() < 1 ||
        count.get<std::uint64_t>() > kLargestDegree + 1) {
      return mismatch(count, fmt::format("an integer 1 to {}", kLargestDegree + 1),
                      fmt::format(".multiplicities[{}]", i));
    }
    flat.insert(flat.end(), count.get<std::size_t>(), (*knots)[i]);
  }
  return flat;
}

Decoded<std::vector<std::vector<double>>> points_of(const json& points, std::size_t dimension,
                                                    const ParameterSpec& spec) {
  if (!points.is_array() || points.empty()) return mismatch(points, "an array of points", ".points");
  // Dimension 0: whatever the first point has; the mechanism's number of joints is not known here.
  if (dimension == 0 && points[0].is_array()) dimension = points[0].size();
  std::vector<std::vector<double>> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const json& point = points[i];
    if (!point.is_array() || point.size() != dimension || dimension == 0 ||
        !std::ranges::all_of(point, [](const json& item) { return item.is_number(); })) {
      return mismatch(point, fmt::format("{} numbers", dimension), fmt::format(".points[{}]", i));
    }
    if (!within(spec.range, point)) return out_of_range(point, spec, fmt::format(".points[{}]", i));
    result.push_back(point.get<std::vector<double>>());
  }
  return result;
}

/// What the wire can check without knowing about curves: types, counts, dimensions. The rest is motion's business.
Decoded<Nurbs> nurbs_of(const json& value, std::size_t dimension, const ParameterSpec& spec) {
  for (const char* key : {"degree", "knots", "points"}) {
    if (!value.contains(key)) return mismatch(value, fmt::format("a member \"{}\" of {}", key, kNurbsMembers));
  }
  const json& degree = value["degree"];
  if (!degree.is_number_unsigned() || degree.get<std::uint64_t>() < 1 || degree.get<std::uint64_t>() > kLargestDegree) {
    return mismatch(degree, fmt::format("an integer 1 to {}", kLargestDegree), ".degree");
  }
  auto knots = flat_knots(value);
  if (!knots) return tl::unexpected<Mismatch>(std::move(knots.error()));
  auto points = points_of(value["points"], dimension, spec);
  if (!points) return tl::unexpected<Mismatch>(std::move(points.error()));
  Decoded<std::vector<double>> weights{std::vector<double>{}};
  if (value.contains("weights") && !value["weights"].is_null()) {
    ParameterSpec any;
    decode_into(value["weights"], any, weights);
    if (!weights) {
      weights.error().where = ".weights" + weights.error().where;
      return tl::unexpected<Mismatch>(std::move(weights.error()));
    }
  }
  Nurbs nurbs;
  nurbs.degree = degree.get<int>();
  nurbs.dimension = points->front().size();
  nurbs.knots = std::move(*knots);
  nurbs.points = std::move(*points);
  nurbs.weights = std::move(*weights);
  return nurbs;
}

}  // namespace

void decode_into(const json& value, const ParameterSpec& spec, Decoded<Vector>& out) {
  if (!value.is_array() || value.size() != 3 ||
      !std::ranges::all_of(value, [](const json& item) { return item.is_number(); })) {
    out = mismatch(value, kVectorExpected);
    return;
  }
  if (!within(spec.range, value)) {
    out = out_of_range(value, spec);
    return;
  }
  out = value.get<Vector>();
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<Frame>& out) {
  if (auto known = only_members(value, {"p", "q"}, kFrameExpected); !known) {
    out = tl::unexpected<Mismatch>(std::move(known.error()));
    return;
  }
  if (!value.contains("p") || !value.contains("q")) {
    out = mismatch(value, kFrameExpected);
    return;
  }
  const auto p = numbers_at<3>(value, "p", kVectorExpected);
  const auto q = quaternion_of(value);
  if (!p) {
    out = tl::unexpected<Mismatch>(p.error());
  } else if (!within(spec.range, value["p"])) {
    out = out_of_range(value["p"], spec, ".p");
  } else if (!q) {
    out = tl::unexpected<Mismatch>(q.error());
  } else {
    out = Frame{*p, *q};
  }
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<ToolPose>& out) {
  if (auto known = only_members(value, {"p", "q", "axis"}, kPoseExpected); !known) {
    out = tl::unexpected<Mismatch>(std::move(known.error()));
    return;
  }
  if (!value.contains("p") || value.contains("q") == value.contains("axis")) {
    out = mismatch(value, kPoseExpected);
    return;
  }
  const auto p = numbers_at<3>(value, "p", kVectorExpected);
  const auto axis = value.contains("axis") ? axis_of(value) : quaternion_of(value).map(tool_axis);
  if (!p) {
    out = tl::unexpected<Mismatch>(p.error());
  } else if (!within(spec.range, value["p"])) {
    out = out_of_range(value["p"], spec, ".p");
  } else if (!axis) {
    out = tl::unexpected<Mismatch>(axis.error());
  } else {
    out = ToolPose{*p, *axis};
  }
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<JointTarget>& out) {
  if (value.is_object() && value.contains("joints")) {
    Decoded<std::vector<double>> joints{std::vector<double>{}};
    decode_into(value["joints"], spec, joints);
    if (!joints) {
      joints.error().where = ".joints" + joints.error().where;
      out = tl::unexpected<Mismatch>(std::move(joints.error()));
    } else if (value.size() != 1) {
      out = mismatch(value, R"({"joints": [...]} alone, or a frame)");
    } else {
      out = JointTarget(std::move(*joints));
    }
    return;
  }
  Decoded<ToolPose> pose{ToolPose{}};
  decode_into(value, spec, pose);
  if (!pose) {
    out = tl::unexpected<Mismatch>(std::move(pose.error()));
  } else {
    out = JointTarget(*pose);
  }
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<TipNurbs>& out) {
  if (auto known = only_members(value, {"degree", "knots", "multiplicities", "points", "weights"}, kNurbsMembers);
      !known) {
    out = tl::unexpected<Mismatch>(std::move(known.error()));
    return;
  }
  auto nurbs = nurbs_of(value, 3, spec);
  if (!nurbs) {
    out = tl::unexpected<Mismatch>(std::move(nurbs.error()));
    return;
  }
  out = TipNurbs{NurbsGeometry{NurbsSpace::Tip, std::move(*nurbs)}};
}

void decode_into(const json& value, const ParameterSpec& spec, Decoded<NurbsGeometry>& out) {
  constexpr const char* kExpected = R"(a NURBS with "space": "pose" or "joint")";
  if (auto known = only_members(value, {"degree", "knots", "multiplicities", "points", "weights", "space"}, kExpected);
      !known) {
    out = tl::unexpected<Mismatch>(std::move(known.error()));
    return;
  }
  if (!value.contains("space") || (value["space"] != "pose" && value["space"] != "joint")) {
    out = mismatch(value.contains("space") ? value["space"] : value, kExpected, ".space");
    return;
  }
  const bool pose = value["space"] == "pose";
  auto nurbs = nurbs_of(value, pose ? 6 : 0, spec);
  if (!nurbs) {
    out = tl::unexpected<Mismatch>(std::move(nurbs.error()));
    return;
  }
  out = NurbsGeometry{pose ? NurbsSpace::Pose : NurbsSpace::Joint, std::move(*nurbs)};
}

json frame_to_json(const Frame& frame) {
  return {{"p", frame.p}, {"q", frame.q}};
}

}  // namespace rmac::gateway
