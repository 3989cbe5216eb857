#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <variant>
#include <vector>

#include "gateway/api/wire_type.hpp"
#include "rmac/motion/move.hpp"

namespace rmac::gateway {

/// What a value should have been, for the error message; the caller adds the parameter's name and the value.
struct Mismatch {
  std::string where;     ///< inside the value, e.g. ".knots[3]"
  std::string found;     ///< the offending value, shortened
  std::string expected;  ///< what goes there
};

template <typename T>
using Decoded = tl::expected<T, Mismatch>;

/// A target of `MoveToJointTarget`: joints as they are, or a tool pose for the inverse kinematics.
using JointTarget = std::variant<std::vector<double>, ToolPose>;

/// A 3D NURBS of `MoveAlongNurbs`, told apart from the n-dimensional one by its type.
struct TipNurbs {
  NurbsGeometry geometry;
};

/// A 64-bit mask, told apart from an integer by its type.
struct Mask {
  std::uint64_t bits = 0;
};

/// An object, or a list of them, that a schema describes.
struct JsonValue {
  nlohmann::json json;
};

/// The value as it may stand in a message: at most some eighty characters.
[[nodiscard]] std::string shortened(const nlohmann::json& value);
/// What was found in the place of what was expected.
[[nodiscard]] inline tl::unexpected<Mismatch> mismatch(const nlohmann::json& value, std::string expected,
                                                       std::string where = {}) {
  return tl::unexpected<Mismatch>(Mismatch{std::move(where), shortened(value), std::move(expected)});
}

/// One overload a C++ type of a parameter: JSON to a value, checked against `spec` (range, enumeration).
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<bool>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<std::int64_t>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<double>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<std::string>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<std::vector<double>>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<std::vector<std::string>>& out);
/// An object, or an array of them, as it came.
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<JsonValue>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<Mask>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<Vector>& out);
/// A whole pose: needs `q`.
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<Frame>& out);
/// A pose of which only the tool axis matters: `q` or `axis`.
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<ToolPose>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<JointTarget>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<TipNurbs>& out);
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<NurbsGeometry>& out);

template <typename T>
void decode_into(const nlohmann::json& value, const ParameterSpec& spec, Decoded<std::optional<T>>& out) {
  Decoded<T> inner{T{}};
  decode_into(value, spec, inner);
  if (inner) {
    out = std::optional<T>(std::move(*inner));
  } else {
    out = tl::unexpected<Mismatch>(std::move(inner.error()));
  }
}

[[nodiscard]] nlohmann::json frame_to_json(const Frame& frame);

}  // namespace rmac::gateway
