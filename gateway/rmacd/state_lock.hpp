#pragma once

#include <filesystem>

#include "rmac/motion/error.hpp"

namespace rmac::gateway {

/// A state folder belongs to one daemon at a time: two would write over each other's tool tables. It is given back when
/// the process ends, however that is.
class StateLock {
 public:
  /// Refused where another process has it; the error names that. A folder in which no file can be made, as one that is
  /// only read, is not locked.
  [[nodiscard]] static Expected<StateLock> take(const std::filesystem::path& state_folder);
  ~StateLock();
  StateLock(StateLock&& other) noexcept;
  StateLock& operator=(StateLock&&) = delete;
  StateLock(const StateLock&) = delete;
  StateLock& operator=(const StateLock&) = delete;

 private:
  explicit StateLock(int descriptor) noexcept : descriptor_(descriptor) {}
  int descriptor_;  ///< -1: none
};

}  // namespace rmac::gateway
