#pragma once

#include <tl/expected.hpp>

#include "clients/legacy/gcode/blocks/refusal.hpp"
#include "clients/legacy/gcode/flow/extent.hpp"
#include "clients/legacy/program/outcome.hpp"
#include "clients/legacy/program/writer.hpp"

namespace rmac::gcode {

/// Line by line in the order in which they are carried out, to the program's end. `flow` is a language's order of
/// lines, and `take` what is done with one.
/// `end`, that the file's end is the program's.
template <typename Flow, typename Take, typename End>
tl::expected<legacy::Summary, legacy::Error> carry_out(Flow& flow, legacy::Writer& writer, const Extent& extent,
                                                       const Take& take, const End& end) {
  try {
    while (!extent.ended() && flow.next()) {
      writer.at_line(flow.line_of_program());
      take(flow.line().text());
    }
    if (!extent.ended()) {
      extent.require_end(flow.line().text().size(), flow.running());
      end();
    }
  } catch (const Refusal& refusal) {
    return tl::unexpected(
        legacy::Error{flow.number(), flow.line().column(refusal.place), refusal.message, flow.file()});
  }
  writer.flush();
  return legacy::Summary{flow.furthest(), writer.moves(), writer.requests()};
}

}  // namespace rmac::gcode
