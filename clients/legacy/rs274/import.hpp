#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>

#include "clients/legacy/rs274/modes.hpp"

namespace rmac::rs274 {

/// Where a program is not taken, and why; from 1.
struct Error {
  std::size_t line = 0, column = 0;
  std::string message;
};

struct Summary {
  std::size_t lines = 0;  ///< of the source
  std::size_t moves = 0, requests = 0;
};

/// Makes `.rmac` text of an RS274/NGC program. What it does not understand, or the format cannot say, is an Error; the
/// sink has got a part of the text then, which is worth nothing.
[[nodiscard]] tl::expected<Summary, Error> import_program(std::string_view program, const Options& options,
                                                          Writer::Sink sink);

}  // namespace rmac::rs274
