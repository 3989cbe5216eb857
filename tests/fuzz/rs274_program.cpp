// A program in RS274/NGC: taken, or refused with a place. What stands behind a line of = is the file that a call of any
// sub finds.
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>

#include "clients/legacy/rs274/import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rmac::rs274::Options options;
  options.approach_mm = {{0, 0, 50}};
  options.offsets[0] = options.offsets[1] = {1, 2, 3};
  options.assume_g43 = true;
  options.unit_mm = 1;
  options.rotary = {{'A', 1, std::nullopt}, {'C', -1, std::nullopt}};
  if (size % 5 > 1) options.rotary[0].centre_mm = {{5, 6, -70}};
  if (size % 5 > 2) options.rotary[1].centre_mm = {{0, 0, 0}};
  options.tool_diameters_mm = {{1, 4}, {2, 0}};
  options.bounds = {.idle_lines = 1000, .output_mb = 1};  // loops without an end are soon noticed
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::size_t mark = std::min(text.find("\n=\n"), text.size());
  const auto find_file =
      [&](const std::string& name) -> tl::expected<std::optional<rmac::rs274::SubFile>, std::string> {
    if (mark == text.size()) return std::nullopt;
    return rmac::rs274::SubFile{name, std::string(text.substr(mark + 3))};
  };
  static_cast<void>(rmac::rs274::import_program(
      text.substr(0, mark), options, [](std::string_view) {}, find_file));
  return 0;
}
