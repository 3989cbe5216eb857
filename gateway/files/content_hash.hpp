#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace rmac::gateway {

/// FNV-1a with 64 bits: tells what changed from what did not, and does no more.
class ContentHash {
 public:
  void add(std::string_view bytes) noexcept {
    for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3U;
  }
  /// False when it cannot be read.
  bool add_file(const std::filesystem::path& file);
  [[nodiscard]] std::string text() const;

 private:
  std::uint64_t value_ = 0xcbf29ce484222325U;
};

}  // namespace rmac::gateway
