// A machine builder's device.json.
#include "gateway/device_database/device_database.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rmac::fuzz::MemoryFile file;
  file.hold(data, size);
  static_cast<void>(rmac::gateway::read_device_json(file.path()));
  return 0;
}
