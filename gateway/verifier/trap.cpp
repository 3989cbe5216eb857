#include "gateway/verifier/trap.hpp"

#include <dlfcn.h>
#include <execinfo.h>
#include <malloc.h>
#include <pthread.h>
#include <signal.h>
#include <sys/prctl.h>
#include <ucontext.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdlib>

namespace rmac::verifier {
namespace {

thread_local bool armed = false;
/// Read by the kernel at each system call of the thread: 0 lets it through, 1 makes it a SIGSYS.
thread_local volatile char block_system_calls = 0;

std::atomic<std::uint64_t> allocations{0}, locks{0}, system_calls{0};
std::array<void*, 32> first_stack{};
std::atomic<int> first_depth{0};

void note(std::atomic<std::uint64_t>& counter) noexcept {
  if (!armed) return;
  armed = false;  // what reports must not report itself
  block_system_calls = 0;
  ++counter;
  if (first_depth == 0) first_depth = backtrace(first_stack.data(), static_cast<int>(first_stack.size()));
  armed = true;
  block_system_calls = 1;
}

#ifdef __x86_64__
/// The kernel did not do what was asked for: this does, so that the thread goes on as if nothing had been, or ends. The
/// rest of the cycle's calls go through, that of returning from here among them: one is enough to fail.
void on_system_call(int, siginfo_t* info, void* context) {
  note(system_calls);
  block_system_calls = 0;
  greg_t* const registers = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const int saved = errno;
  const long result = syscall(info->si_syscall, registers[REG_RDI], registers[REG_RSI], registers[REG_RDX],
                              registers[REG_R10], registers[REG_R8], registers[REG_R9]);
  registers[REG_RAX] = result == -1 ? -errno : result;
  errno = saved;
}

bool catch_system_calls() noexcept {
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO;
  sigaction(SIGSYS, &action, nullptr);
  constexpr int kSetSyscallUserDispatch = 59;  // <linux/prctl.h> from Linux 5.11 on
  constexpr unsigned long kOn = 1;
  return prctl(kSetSyscallUserDispatch, kOn, 0UL, 0UL, &block_system_calls) == 0;
}
#else
bool catch_system_calls() noexcept {
  return false;
}
#endif

/// The next definition of a function that this binary defines itself.
template <typename Function>
Function* next(const char* name) noexcept {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace

bool prepare_trap() {
  std::array<void*, 4> stack{};
  (void)backtrace(stack.data(), static_cast<int>(stack.size()));  // its first call allocates
  return catch_system_calls();
}

void arm_trap() noexcept {
  armed = true;
  block_system_calls = 1;
}

void disarm_trap() noexcept {
  block_system_calls = 0;
  armed = false;
}

bool trap_caught() noexcept {
  return allocations.load(std::memory_order_relaxed) + locks.load(std::memory_order_relaxed) +
             system_calls.load(std::memory_order_relaxed) >
         0;
}

TrapCounts take_trap_counts() {
  TrapCounts counts{allocations.exchange(0), locks.exchange(0), system_calls.exchange(0), {}};
  const int depth = first_depth.exchange(0);
  char** const names = depth > 0 ? backtrace_symbols(first_stack.data(), depth) : nullptr;
  for (int i = 0; names != nullptr && i < depth; ++i) counts.first += std::string(names[i]) + "\n";
  std::free(names);
  return counts;
}

std::size_t heap_in_use() noexcept {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

}  // namespace rmac::verifier

// The C library's own names, so that whatever this binary and its modules call comes by here.
extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmissing-attributes"

void* malloc(std::size_t size) noexcept {
  rmac::verifier::note(rmac::verifier::allocations);
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  rmac::verifier::note(rmac::verifier::allocations);
  return __libc_calloc(count, size);
}
void* realloc(void* block, std::size_t size) noexcept {
  rmac::verifier::note(rmac::verifier::allocations);
  return __libc_realloc(block, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  rmac::verifier::note(rmac::verifier::allocations);
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  *block = memalign(alignment, size);
  return *block == nullptr ? ENOMEM : 0;
}
void free(void* block) noexcept {
  if (block != nullptr) rmac::verifier::note(rmac::verifier::allocations);
  __libc_free(block);
}

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_mutex_t*)>("pthread_mutex_lock");
  rmac::verifier::note(rmac::verifier::locks);
  return real(mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_mutex_t*)>("pthread_mutex_trylock");
  rmac::verifier::note(rmac::verifier::locks);
  return real(mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_rwlock_t*)>("pthread_rwlock_rdlock");
  rmac::verifier::note(rmac::verifier::locks);
  return real(lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_rwlock_t*)>("pthread_rwlock_wrlock");
  rmac::verifier::note(rmac::verifier::locks);
  return real(lock);
}
int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_cond_t*)>("pthread_cond_signal");
  rmac::verifier::note(rmac::verifier::locks);
  return real(condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  static auto* const real = rmac::verifier::next<int(pthread_cond_t*)>("pthread_cond_broadcast");
  rmac::verifier::note(rmac::verifier::locks);
  return real(condition);
}

#pragma GCC diagnostic pop
}
