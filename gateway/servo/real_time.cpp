#include "gateway/servo/real_time.hpp"

#include <fmt/format.h>
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace rmac::gateway {

namespace {

/// Locks all memory, now and later; nullptr, or why not.
const char* lock_memory() {
  rlimit limit{};
  getrlimit(RLIMIT_MEMLOCK, &limit);
  // Below a limit, locking what is to come would make some later allocation fail.
  if (limit.rlim_cur != RLIM_INFINITY && geteuid() != 0) return "the limit on locked memory is not lifted";
  return mlockall(MCL_CURRENT | MCL_FUTURE) == 0 ? nullptr : std::strerror(errno);
}

/// Has every page of the calling thread's stack in memory, also where it may not be locked there; nullptr, or why not.
const char* prefault_stack() {
  pthread_attr_t attributes;
  if (const int error = pthread_getattr_np(pthread_self(), &attributes); error != 0) return std::strerror(error);
  void* lowest = nullptr;
  std::size_t size = 0;
  pthread_attr_getstack(&attributes, &lowest, &size);
  pthread_attr_destroy(&attributes);
  return madvise(lowest, size, MADV_POPULATE_WRITE) == 0 ? nullptr : std::strerror(errno);
}

}  // namespace

std::vector<std::string> enter_real_time(const RealTimeWish& wish) {
  std::vector<std::string> missing;
  if (const char* reason = wish.lock_memory ? lock_memory() : nullptr) {
    missing.push_back(fmt::format(
        "memory is not locked ({}): set LimitMEMLOCK=infinity in the unit, or `ulimit -l unlimited`", reason));
  }
  if (const char* reason = wish.lock_memory ? prefault_stack() : nullptr) {
    missing.push_back(fmt::format("memory of the cycle's stack is not there beforehand ({}): free some", reason));
  }
  sched_param parameter{};
  parameter.sched_priority = wish.priority;
  if (const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter); error != 0) {
    missing.push_back(fmt::format(
        "SCHED_FIFO priority {} is not granted ({}): set AmbientCapabilities=CAP_SYS_NICE or LimitRTPRIO={} "
        "in the unit, or run `setcap cap_sys_nice+ep` on rmacd",
        wish.priority, std::strerror(error), wish.priority));
  }
  if (wish.cpu >= 0) {
    cpu_set_t set;
    CPU_ZERO(&set);
    const bool fits = wish.cpu < CPU_SETSIZE;
    if (fits) CPU_SET(static_cast<std::size_t>(wish.cpu), &set);
    const int error = fits ? pthread_setaffinity_np(pthread_self(), sizeof(set), &set) : EINVAL;
    if (error != 0) {
      missing.push_back(fmt::format("CPU {} is not available ({}): choose one of those that `nproc` counts, or -1",
                                    wish.cpu, std::strerror(error)));
    }
  }
  return missing;
}

}  // namespace rmac::gateway
