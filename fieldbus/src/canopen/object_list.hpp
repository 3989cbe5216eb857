#pragma once

#include <string>

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// Below are data types, which fill room in a PDO.
inline constexpr std::uint16_t kFirstObject = 0x1000;

/// Reads a PDO's contents: `index:sub/bits` in hexadecimal, hexadecimal and decimal, with spaces between, for example
/// "6040:00/16 607A:00/32". Whole bytes, 64 bits at most.
[[nodiscard]] Expected<std::vector<MappedObject>> read_mapping(const std::string& text);

/// Reads values to write: `index:sub/bits=value`, with spaces between; a value is decimal, or hexadecimal after 0x.
[[nodiscard]] Expected<std::vector<SdoWrite>> read_setup(const std::string& text);

/// Setpoints hold a controlword, and nothing that the master could not fill.
[[nodiscard]] Expected<> check_setpoints(const std::vector<MappedObject>& objects);
/// Answers hold a statusword; what the master does not know it passes over.
[[nodiscard]] Expected<> check_answers(const std::vector<MappedObject>& objects);
/// A first PDO's contents and a second one's, which are checked as one.
[[nodiscard]] std::vector<MappedObject> together(std::vector<MappedObject> objects,
                                                 const std::vector<MappedObject>& more);

}  // namespace rmac::fieldbus::canopen
