#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace rmac::legacy {

/// Why a part of a program is not taken. Thrown within the reader of a language only, whose import_program() makes an
/// Error of it; what its place counts is that reader's.
struct Refusal {
  std::size_t place = 0;
  std::string message;
};

[[noreturn]] inline void refuse(std::size_t place, std::string message) {
  throw Refusal{place, std::move(message)};
}

}  // namespace rmac::legacy
