#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "clients/legacy/apt/moves/options.hpp"
#include "clients/legacy/program/outcome.hpp"

namespace rmac::apt {

/// Makes `.rmac` text of a CL file: APT as CAM systems write it, with ISO 4343's words. What it does not understand, or
/// the format cannot say, is an Error; the sink has got a part of the text then, which is worth nothing.
[[nodiscard]] tl::expected<legacy::Summary, legacy::Error> import_program(std::string_view program,
                                                                          const Options& options,
                                                                          legacy::Writer::Sink sink);

}  // namespace rmac::apt
