#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rmac/fieldbus/eds/device_description.hpp"
#include "rmac/fieldbus/eds/typed_value.hpp"

namespace rmac::fieldbus::canopen {

/// What an object is: by the device's EDS or DCF where there is one, and by the standards where that says nothing (CiA
/// 301, CiA 402-2; of a drive for several axes, each axis). The unit is the standards' alone, for an EDS has none.
struct ObjectMeaning {
  std::string name;                   ///< empty: unknown
  std::optional<eds::DataType> type;  ///< none: unknown
  std::string unit;                   ///< empty: none, or unknown
  bool is_pattern = false;            ///< of bits, which a person reads in hexadecimal
};
[[nodiscard]] ObjectMeaning meaning_of(ObjectAddress object, const eds::DeviceDescription* description);

/// The value of an object.
[[nodiscard]] eds::TypedValue value_of(const ObjectMeaning& meaning, std::span<const std::uint8_t> bytes);

/// As a person reads it, with its unit, and with what a number stands for: "0637h (operation enabled)", "12 counts".
[[nodiscard]] std::string value_text(ObjectAddress object, const ObjectMeaning& meaning,
                                     std::span<const std::uint8_t> bytes);

/// "6041h:00 Statusword", or its address alone.
[[nodiscard]] std::string object_text(ObjectAddress object, const ObjectMeaning& meaning);

/// An object as a person writes it, in hexadecimal: "6041", "6041:0", "0x6041:00", "6041h:00". None given, the
/// sub-index is 0.
[[nodiscard]] Expected<ObjectAddress> read_object_address(std::string_view text);

}  // namespace rmac::fieldbus::canopen
