#pragma once

#include <cstddef>
#include <string>

namespace rmac::legacy {

/// Where a program is not taken, and why; from 1.
struct Error {
  std::size_t line = 0, column = 0;
  std::string message;
  std::string file{};  ///< that the line is of, where it is not the program itself
};

struct Summary {
  std::size_t lines = 0;  ///< of the source
  std::size_t moves = 0, requests = 0;
};

}  // namespace rmac::legacy
