// A drive maker's EDS, or a DCF.
#include "memory_file.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_cast<void>(rmac::fieldbus::eds::parse_device_description(rmac::fuzz::text_of(data, size), "drive.eds"));
  return 0;
}
