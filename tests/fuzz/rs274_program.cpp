// A program in RS274/NGC: taken, or refused with a place.
#include <cstdint>
#include <string_view>

#include "clients/legacy/rs274/import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rmac::rs274::Options options;
  options.approach_mm = {{0, 0, 50}};
  options.offsets[0] = options.offsets[1] = {1, 2, 3};
  options.assume_g43 = true;
  options.unit_mm = 1;
  options.tool_diameters_mm = {{1, 4}, {2, 0}};
  options.bounds = {.idle_lines = 1000, .output_mb = 1};  // loops without an end are soon noticed
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(rmac::rs274::import_program(text, options, [](std::string_view) {}));
  return 0;
}
