#pragma once

#include <cstdint>
#include <string>

namespace rmac::real_time_test {

/// What must not happen on the servo thread in a cycle. This binary's own malloc, free and lock functions stand before
/// those of the C library and count while the calling thread is armed; system calls are caught by the kernel (syscall
/// user dispatch), where it can do that.
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
/// What armed threads did since the last call.
[[nodiscard]] TrapCounts take_trap_counts();

}  // namespace rmac::real_time_test
