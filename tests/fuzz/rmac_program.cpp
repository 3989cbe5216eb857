// A program, a request a line.
#include "gateway/rmac/program/program.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rmac::fuzz::MemoryFile file;
  file.hold(data, size);
  static_cast<void>(rmac::cli::read_program(file.path().string()));
  return 0;
}
