#pragma once

#include <atomic>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "gateway/verifier/trap.hpp"

namespace rmac::verifier {

/// Where a worker is, in memory that it shares with whoever watches it: what is left of it when it crashes or hangs.
struct Place {
  struct Numbers {
    char name[16];
    std::uint32_t count;
    double numbers[64];
  };

  std::atomic<std::uint64_t> steps;  ///< grows with each call, so a call that does not return shows
  std::atomic<int> forbidden_call;   ///< number of the system call that it may not make, and made
  char call[64];
  std::uint32_t values_count;
  Numbers values[3];
};

/// Numbers of one argument of a call.
struct Argument {
  const char* name;
  std::span<const double> numbers;
};

/// Notes each call of the module under check before it is made, and traps what the calls of the cycle must not do.
class Watch {
 public:
  explicit Watch(Place& place) : place_(place) {}

  /// A call off the cycle, or a step that is no call of the module.
  void step(const char* call) noexcept { note(call, {}); }

  /// A call of the cycle, with what it is given.
  template <typename Function>
  decltype(auto) on_cycle(const char* call, std::initializer_list<Argument> arguments, Function&& function) noexcept {
    note(call, arguments);
    const Armed armed(*this);
    return function();
  }

  /// The first call of the cycle that allocated, locked or called the system, and how.
  [[nodiscard]] Checked misdeed() const;

 private:
  struct Armed {
    /// The first misdeed is enough; looking where others come from takes long.
    explicit Armed(Watch& owner) : watch(owner) {
      if (!watch.misdeed_) arm_trap();
    }
    Armed(const Armed&) = delete;
    Armed& operator=(const Armed&) = delete;
    ~Armed() {
      disarm_trap();
      if (trap_caught()) watch.keep_misdeed();
    }
    Watch& watch;
  };

  void note(const char* call, std::initializer_list<Argument> arguments) noexcept;
  void keep_misdeed() noexcept;

  Place& place_;
  std::optional<CounterExample> misdeed_;
};

/// What the place shows, in the words of a counter-example.
[[nodiscard]] CounterExample example_at(const Place& place, std::string check, std::string what);

}  // namespace rmac::verifier
