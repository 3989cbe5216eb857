// A CL file in APT: taken, or refused with a place.
#include <cstdint>
#include <string_view>

#include "clients/legacy/apt/import.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  rmac::apt::Options options;
  options.approach_mm = {{0, 0, 50}};
  options.reference_mm = {{1, 2, 300}};
  options.unit_mm = 1;
  options.multax = true;
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(rmac::apt::import_program(text, options, [](std::string_view) {}));
  return 0;
}
