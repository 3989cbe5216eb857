#pragma once

#include <cstddef>
#include <string>
#include <utility>

namespace rmac::rs274 {

/// Why a block is not taken. Thrown within this room only; import_program() makes an Error of it.
struct Refusal {
  std::size_t place = 0;  ///< in Line::text()
  std::string message;
};

[[noreturn]] inline void refuse(std::size_t place, std::string message) {
  throw Refusal{place, std::move(message)};
}

}  // namespace rmac::rs274
