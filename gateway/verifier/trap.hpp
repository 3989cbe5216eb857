#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace rmac::verifier {

/// What must not happen on the servo thread in a cycle. A program that has trap.cpp among its sources has malloc, free
/// and lock functions of its own before those of the C library, which count while the calling thread is armed; system
/// calls are caught by the kernel (syscall user dispatch), where it can do that. Under a sanitizer, which brings its
/// own malloc and locks, trap_sanitized.cpp stands in: it counts allocations alone.
struct TrapCounts {
  std::uint64_t allocations = 0;  ///< malloc and its kin, free included
  std::uint64_t locks = 0;        ///< mutexes, read-write locks, condition variables
  std::uint64_t system_calls = 0;
  std::string first;  ///< where the first of them came from, as a stack of symbols
};

/// Prepares the calling thread; false where the kernel cannot catch system calls. Once a thread, before arming it.
bool prepare_trap();
void arm_trap() noexcept;
void disarm_trap() noexcept;
/// Whether there is anything to take. Real-time safe.
[[nodiscard]] bool trap_caught() noexcept;
/// What armed threads did since the last call.
[[nodiscard]] TrapCounts take_trap_counts();
/// Bytes that were allocated and not freed.
[[nodiscard]] std::size_t heap_in_use() noexcept;

}  // namespace rmac::verifier
