#pragma once

#include <string_view>
#include <tl/expected.hpp>

#include "clients/legacy/fanuc/blocks/haas_codes.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/program/outcome.hpp"

namespace rmac::fanuc {

using gcode::Options, gcode::Point, gcode::Writer;
using legacy::Error, legacy::Summary;

/// Makes `.rmac` text of a program for a Fanuc-type control, or a Haas. What it does not understand, or the format
/// cannot say, is an Error; the sink has got a part of the text then, which is worth nothing.
[[nodiscard]] tl::expected<Summary, Error> import_program(std::string_view program, const Options& options,
                                                          Writer::Sink sink, Dialect dialect = Dialect::Fanuc);

/// Whether Options::passed_m may name an M code: it is not carried out whatever that says.
[[nodiscard]] bool may_pass_over(int number, Dialect dialect) noexcept;
/// Whether an M code of a Haas switches on an output that Options::outputs names.
[[nodiscard]] bool switches_output(int number) noexcept;

}  // namespace rmac::fanuc
