// A program for a Fanuc-type control, or a Haas: taken, or refused with a place.
#include <cstdint>
#include <string_view>

#include "clients/legacy/fanuc/import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rmac::fanuc::Options options;
  options.approach_mm = {{0, 0, 50}};
  options.reference_mm = options.second_reference_mm = {{0, 0, 100}};
  options.offsets[0] = options.offsets[1] = options.offsets[6] = {1, 2, 3};
  options.assume_g43 = true;
  options.unit_mm = 1;
  options.rotary = {{'C', 1, std::nullopt}, {'A', -1, std::nullopt}};
  if (size % 5 > 1) options.rotary[0].centre_mm = {{0, 0, 0}};
  if (size % 5 > 2) options.rotary[1].centre_mm = {{5, 6, -70}};
  if (size % 7 > 1)
    options.rotary_way = size % 7 > 2 ? rmac::gcode::RotaryWay::Written : rmac::gcode::RotaryWay::Shorter;
  options.assume_end = size % 3 == 1;
  options.outputs = {{88, "Through"}};
  options.tool_diameters_mm = {{1, 4}, {2, 0}};
  options.whole_numbers = rmac::gcode::WholeNumbers::Units;
  options.variables = {{500, 1}};
  options.block_delete = size % 2 == 1;
  options.bounds = {.idle_lines = 1000, .output_mb = 1};  // loops without an end are soon noticed
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto dialect = size % 11 > 4 ? rmac::fanuc::Dialect::Haas : rmac::fanuc::Dialect::Fanuc;
  static_cast<void>(rmac::fanuc::import_program(
      text, options, [](std::string_view) {}, dialect));
  return 0;
}
