// A tool table.
#include "gateway/tools/tool_rack.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rmac::fuzz::MemoryFile file;
  file.hold(data, size);
  static_cast<void>(rmac::gateway::read_tool_table(file.path()));
  return 0;
}
