#pragma once

#include <cstddef>

namespace rmac::verifier {

/// What a process that runs a module may use.
struct Bounds {
  double cpu_s = 120;                                ///< of CPU time in all
  double call_cpu_s = 1;                             ///< of CPU time in one call
  double silence_s = 10;                             ///< in one call, without computing
  std::size_t memory_bytes = std::size_t{1} << 30U;  ///< of address space; not bounded under a sanitizer
};

/// Gives up, for good, what the calling process does not need to run a module: capabilities, the right to gain any,
/// core dumps, and resources beyond `bounds`. It dies with its parent. What the system does not let it give up it
/// keeps.
void confine(const Bounds& bounds) noexcept;

}  // namespace rmac::verifier
