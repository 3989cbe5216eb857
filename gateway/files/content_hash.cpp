#include "gateway/files/content_hash.hpp"

#include <fmt/format.h>

#include <array>
#include <fstream>

namespace rmac::gateway {

bool ContentHash::add_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::array<char, 65536> buffer{};
  while (stream.read(buffer.data(), buffer.size()) || stream.gcount() > 0) {
    add({buffer.data(), static_cast<std::size_t>(stream.gcount())});
  }
  return stream.eof();
}

std::string ContentHash::text() const {
  return fmt::format("{:016x}", value_);
}

}  // namespace rmac::gateway
