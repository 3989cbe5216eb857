#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/program/outcome.hpp"
#include "clients/legacy/rs274/flow/sources.hpp"

namespace rmac::rs274 {

using gcode::Options, gcode::Point, gcode::Writer;
using legacy::Error, legacy::Summary;

/// Makes `.rmac` text of an RS274/NGC program. What it does not understand, or the format cannot say, is an Error; the
/// sink has got a part of the text then, which is worth nothing. Subs that are not in the program are looked for in the
/// files that `find_file` finds.
[[nodiscard]] tl::expected<Summary, Error> import_program(std::string_view program, const Options& options,
                                                          Writer::Sink sink, FindFile find_file = {});

}  // namespace rmac::rs274
