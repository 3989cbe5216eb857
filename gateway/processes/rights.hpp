#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace rmac::gateway {

/// Gives up, for good, what the calling process does not need to run what others wrote: capabilities, the right to gain
/// any, core dumps, CPU time beyond `cpu_s` and address space beyond `memory_bytes` (not bounded under a sanitizer). It
/// dies with its parent. What the system refuses, for a person.
[[nodiscard]] std::optional<std::string> give_up_rights(double cpu_s, std::size_t memory_bytes);

/// Where memory runs out, this process and what it starts are ended first, and not the one that moves the machine.
void offer_memory() noexcept;

}  // namespace rmac::gateway
