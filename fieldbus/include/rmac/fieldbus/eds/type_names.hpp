#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "rmac/fieldbus/eds/object_entry.hpp"

namespace rmac::fieldbus::eds {

/// What a data type is called in the standard: "UNSIGNED16" (CiA 301, 7.1.4 to 7.1.6). A maker's own is named by its
/// index.
[[nodiscard]] std::string type_name(DataType type);

/// A data type by its name in the standard or by the short one of CiA 309-3 ("u16"), whatever the case. None for
/// others.
[[nodiscard]] std::optional<DataType> read_type_name(std::string_view text);

/// All short names, for messages: "b, i8, i16, ...".
[[nodiscard]] std::string short_type_names();

}  // namespace rmac::fieldbus::eds
