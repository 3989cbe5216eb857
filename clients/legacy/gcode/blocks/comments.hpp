#pragma once

#include <optional>
#include <string_view>

#include "clients/legacy/gcode/blocks/line.hpp"

namespace rmac::gcode {

/// Throws a Refusal where a comment of the line has a control record what it probes: (PROBEOPEN …) and (PROBECLOSE).
/// (DEBUG, …), (PRINT, …) and (LOG…) write for a person, and change nothing.
void refuse_active_comments(const Line& line);

/// The text of a comment (MSG, text); none where a comment is none of these.
[[nodiscard]] std::optional<std::string_view> message_of(std::string_view comment);

}  // namespace rmac::gcode
