#pragma once

#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::fieldbus::canopen {

/// An object that the standards define, as far as its name and unit go: CiA 301 (communication), CiA 402-2 (drives).
struct StandardObject {
  ObjectAddress object;
  const char* name;
  eds::DataType type;
  const char* unit = "";
  bool is_pattern = false;  ///< of bits
};

/// Null where the standards define none, or none that is here. Of any axis of a node.
[[nodiscard]] const StandardObject* find_standard_object(ObjectAddress object) noexcept;

/// The object of a node's first axis that this one is of another.
[[nodiscard]] ObjectAddress of_first_axis(ObjectAddress object) noexcept;

inline constexpr unsigned kMostMode = 10;  ///< of those that CiA 402-2 names
/// A mode of operation by its number (6060h); empty where the standard names none.
[[nodiscard]] const char* mode_name(std::int64_t mode) noexcept;

}  // namespace rmac::fieldbus::canopen
