#pragma once

#include <optional>
#include <string>
#include <utility>

#include "rmac/motion/error.hpp"

namespace rmac::vdrive {

/// Lines from standard input ("-") or a FIFO, as they come; it never waits.
class LineInput {
 public:
  [[nodiscard]] static Expected<LineInput> open(const std::string& path);
  LineInput(LineInput&& other) noexcept : file_(std::exchange(other.file_, -1)), kept_(std::move(other.kept_)) {}
  LineInput& operator=(LineInput&&) = delete;
  ~LineInput();

  [[nodiscard]] std::optional<std::string> next();

 private:
  explicit LineInput(int file) : file_(file) {}

  int file_;
  std::string kept_;
};

}  // namespace rmac::vdrive
