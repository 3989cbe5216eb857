#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rmac::gateway {

/// Gives up, for good, what the calling process does not need to run what others wrote: capabilities, the right to gain
/// any, core dumps, CPU time beyond `cpu_s` and address space beyond `memory_bytes` (not bounded under a sanitizer). It
/// dies with its parent. What the system refuses, for a person.
[[nodiscard]] std::optional<std::string> give_up_rights(double cpu_s, std::size_t memory_bytes);

}  // namespace rmac::gateway
