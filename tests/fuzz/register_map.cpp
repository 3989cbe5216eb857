// The register maps of a frequency converter and of inputs and outputs.
#include "gateway/buses/register_map_file.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rmac::fuzz::MemoryFile file;
  file.hold(data, size);
  static_cast<void>(rmac::gateway::read_spindle_map(file.path()));
  static_cast<void>(rmac::gateway::read_io_map(file.path()));
  return 0;
}
