#include "gateway/api/wire_type.hpp"

namespace rmac::gateway {

const char* to_string(WireType type) noexcept {
  switch (type) {
    case WireType::Null:
      return "null";
    case WireType::Boolean:
      return "boolean";
    case WireType::Integer:
    case WireType::Mask:
      return "integer";
    case WireType::Number:
      return "number";
    case WireType::String:
      return "string";
    case WireType::Numbers:
      return "array<number>";
    case WireType::Strings:
      return "array<string>";
    case WireType::Vector:
      return "Vector";
    case WireType::Frame:
    case WireType::JointTarget:
      return "Frame";
    case WireType::Nurbs:
      return "Nurbs";
    case WireType::NurbsNd:
      return "NurbsND";
    case WireType::Object:
      return "object";
    case WireType::Objects:
      return "array<object>";
  }
  return "null";
}

}  // namespace rmac::gateway
