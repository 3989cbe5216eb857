#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>

namespace rmac::verifier {

/// What a process that runs a module may use.
struct Bounds {
  double cpu_s = 120;                                ///< of CPU time in all
  double call_cpu_s = 1;                             ///< of CPU time in one call
  double silence_s = 10;                             ///< in one call, without computing
  std::size_t memory_bytes = std::size_t{1} << 30U;  ///< of address space; not bounded under a sanitizer
};

/// `fork` into user, PID, network, mount and IPC namespaces of the child's own (user_namespaces(7)): it sees no other
/// process, no network, and what it starts ends with it. -1 with `errno` where the kernel refuses that. For a process
/// of one thread.
[[nodiscard]] pid_t fork_apart() noexcept;

/// Gives up, for good, what the calling process, a child of `fork_apart`, does not need to run a module: the file
/// system becomes read-only and without devices but for a temporary folder of its own, capabilities and the right to
/// gain any go, and the system calls that are left are those that compute, and read files. Asking for another one ends
/// the process with `kForbiddenCall`, and its number stands in `forbidden` then. It dies with its parent. What the
/// system refuses, for a person; then nothing may be run.
[[nodiscard]] std::optional<std::string> confine(const Bounds& bounds, std::atomic<int>& forbidden);

/// Exit codes of a confined process: it asked for a system call that it may not make, or aborted.
inline constexpr int kForbiddenCall = 125, kAborted = 126;

/// Name of a system call, as in its manual page.
[[nodiscard]] std::string system_call_name(int number);

}  // namespace rmac::verifier
