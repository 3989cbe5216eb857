#pragma once

#include <string_view>

namespace rmac::gateway {

/// The JSON schemas of etc/, compiled in, so that binary and schema cannot disagree and no path matters.
[[nodiscard]] std::string_view device_schema_text();
[[nodiscard]] std::string_view rmacd_schema_text();
[[nodiscard]] std::string_view modbus_spindle_schema_text();
[[nodiscard]] std::string_view modbus_io_schema_text();
[[nodiscard]] std::string_view drive_schema_text();
[[nodiscard]] std::string_view tools_schema_text();
[[nodiscard]] std::string_view setup_schema_text();
[[nodiscard]] std::string_view materials_schema_text();
[[nodiscard]] std::string_view measuring_plan_schema_text();

}  // namespace rmac::gateway
