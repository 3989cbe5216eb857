#pragma once

#include <atomic>
#include <optional>
#include <string>

namespace rmac::verifier {

/// From here on the process may make the system calls that computing and reading files need, and no other: one ends it
/// with `kForbiddenCall`, and `forbidden` tells its number. Why that cannot be had, for a person. A handler of SIGSYS
/// that is there goes on being called for what is not this filter's.
[[nodiscard]] std::optional<std::string> filter_system_calls(std::atomic<int>& forbidden);

}  // namespace rmac::verifier
