#include <atomic>

#include "gateway/verifier/trap.hpp"

// Of <sanitizer/allocator_interface.h>, which not every compiler's package has.
extern "C" {
int __sanitizer_install_malloc_and_free_hooks(void (*malloc_hook)(const volatile void*, std::size_t),
                                              void (*free_hook)(const volatile void*));
std::size_t __sanitizer_get_current_allocated_bytes();
}

namespace rmac::verifier {
namespace {

thread_local bool armed = false;
std::atomic<std::uint64_t> allocations{0};

void note() noexcept {
  if (armed) ++allocations;
}

}  // namespace

bool prepare_trap() {
  static const bool installed [[maybe_unused]] =
      __sanitizer_install_malloc_and_free_hooks([](const volatile void*, std::size_t) { note(); },
                                                [](const volatile void*) { note(); }) != 0;
  return false;
}

void arm_trap() noexcept {
  armed = true;
}

void disarm_trap() noexcept {
  armed = false;
}

bool trap_caught() noexcept {
  return allocations.load(std::memory_order_relaxed) > 0;
}

TrapCounts take_trap_counts() {
  return {allocations.exchange(0), 0, 0, {}};
}

std::size_t heap_in_use() noexcept {
  return __sanitizer_get_current_allocated_bytes();
}

}  // namespace rmac::verifier
