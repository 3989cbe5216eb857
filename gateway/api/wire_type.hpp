#pragma once

#include <cstdint>
#include <string>

#include "gateway/api/enumeration.hpp"
#include "gateway/json/range.hpp"

namespace rmac::gateway {

/// The types of the wire. What they look like as JSON stands in docs/api.md and in `rpc.discover`.
enum class WireType {
  Null,
  Boolean,
  Integer,
  Number,
  String,
  Numbers,  ///< array of numbers
  Strings,  ///< array of strings
  Mask,     ///< 64 bits: an integer up to 2^53-1 or a "0x…" string
  Vector,
  Frame,
  JointTarget,  ///< a Frame, or {"joints": […]}
  Nurbs,
  NurbsNd,
  Object,
  Objects,  ///< array of objects
};

/// As the specification spells it, e.g. "array<number>".
[[nodiscard]] const char* to_string(WireType type) noexcept;

struct ParameterSpec {
  std::string name;
  WireType type = WireType::Null;
  std::string unit;
  Range range;
  const Enumeration* enumeration = nullptr;
  bool optional = false;
  bool null_is_none = false;  ///< of an optional one: null is the same as to leave it out
  std::string note;
};

struct ResultSpec {
  WireType type = WireType::Null;
  std::string unit;
  const Enumeration* enumeration = nullptr;
};

}  // namespace rmac::gateway
