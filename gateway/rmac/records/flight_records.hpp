#pragma once

#include <string>
#include <string_view>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "gateway/rmac/wire/notes.hpp"

namespace rmac::cli {

/// Has the last seconds of every cycle written, and waits until they are: the event that told of it.
[[nodiscard]] Result<EventNote> record_flight(Connection& connection);

/// The text of a flight record: a line of JSON, then CSV.
[[nodiscard]] Result<std::string> fetch_flight_record(Connection& connection, const std::string& name);

/// Writes a text; `-` is standard output.
[[nodiscard]] Result<> write_file(const std::string& file, std::string_view text);

}  // namespace rmac::cli
