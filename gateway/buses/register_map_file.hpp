#pragma once

#include <filesystem>

#include "rmac/fieldbus/modbus/register_map.hpp"

namespace rmac::gateway {

/// Read a Modbus register map (etc/modbus-spindle.schema.json, etc/modbus-io.schema.json) and check it as a whole. The
/// error names file, entry, value and what is allowed.
[[nodiscard]] Expected<fieldbus::modbus::SpindleMap> read_spindle_map(const std::filesystem::path& file);
[[nodiscard]] Expected<fieldbus::modbus::IoMap> read_io_map(const std::filesystem::path& file);

}  // namespace rmac::gateway
