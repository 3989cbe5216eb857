#pragma once

#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "gateway/rmac/wire/notes.hpp"

namespace rmac::cli {

/// Waits until nothing moves and nothing is queued; the state then. Ends early with `failure` as soon as that holds a
/// text, which notifications may write meanwhile.
[[nodiscard]] Result<StateNote> wait_for_rest(Connection& connection, const std::string& failure);

}  // namespace rmac::cli
