#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "gateway/verifier/call_times.hpp"
#include "gateway/verifier/guarded_output.hpp"
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
  char doing[64];                    ///< what the worker is at
  char call[64];                     ///< of the module, last
  std::atomic<bool> in_call;         ///< it has not come back
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
  void step(const char* doing) noexcept;

  /// A call of the cycle, with what it is given.
  template <typename Function>
  decltype(auto) on_cycle(const char* call, std::initializer_list<Argument> arguments, Function&& function) noexcept {
    const InCall in_call(place_);
    note(call, arguments);
    const Armed armed(*this);
    return function();
  }

  /// Calls of the cycle in great number, which are not watched one by one.
  void calls_on_cycle(const char* call, const std::function<void()>& calls) noexcept {
    on_cycle(call, {}, [&] { calls(); });
  }

  /// A call of a port that has no state: `function` is given an output in place of `output`, and may be called again.
  template <typename Function>
  auto stateless(const char* call, std::initializer_list<Argument> arguments, std::span<double> output,
                 Function&& function) noexcept {
    const InCall in_call(place_);
    const std::span<double> lent = output_.lend(output);
    const Judged judged(*this, call, output, [&] { (void)function(lent); });
    return on_cycle(call, arguments, [&] { return function(lent); });
  }

  /// What is wrong with the calls so far: the first that allocated, locked, called the system, wrote beyond its output,
  /// or took too long.
  [[nodiscard]] Checked misdeed() const;

 private:
  struct InCall {
    explicit InCall(Place& where) : place(where), before(place.in_call.exchange(true, std::memory_order_relaxed)) {}
    InCall(const InCall&) = delete;
    InCall& operator=(const InCall&) = delete;
    ~InCall() { place.in_call.store(before, std::memory_order_relaxed); }
    Place& place;
    bool before;
  };

  struct Armed {
    /// The first misdeed is enough; looking where others come from takes long.
    explicit Armed(Watch& owner) : watch(owner) {
      if (!watch.misdeed_) arm_trap();
    }
    Armed(const Armed&) = delete;
    Armed& operator=(const Armed&) = delete;
    ~Armed() {
      disarm_trap();
      if (trap_caught()) watch.keep_trapped();
    }
    Watch& watch;
  };

  /// Looks at a call of a port without state once it is done.
  template <typename Again>
  struct Judged {
    Judged(Watch& owner, const char* name, std::span<double> result, Again call_again)
        : watch(owner), call(name), output(result), again(call_again) {}
    Judged(const Judged&) = delete;
    Judged& operator=(const Judged&) = delete;
    ~Judged() {
      const auto took = std::chrono::steady_clock::now() - begun;
      watch.output_.give_back(output);
      if (watch.misdeed_) return;
      if (watch.output_.overrun()) {
        watch.keep("overrun", "it writes outside of its output");
      } else {
        watch.keep("call time", watch.times_.judge(call, took, [this] {
          watch.place_.steps.fetch_add(1, std::memory_order_release);
          again();
        }));
      }
    }
    Watch& watch;
    const char* call;
    std::span<double> output;
    Again again;
    std::chrono::steady_clock::time_point begun = std::chrono::steady_clock::now();
  };

  void note(const char* call, std::initializer_list<Argument> arguments) noexcept;
  void keep_trapped() noexcept;
  /// A misdeed of the call at hand, unless there is nothing to say.
  void keep(const char* check, std::string what) noexcept;

  Place& place_;
  GuardedOutput output_;
  CallTimes times_;
  std::optional<CounterExample> misdeed_;
};

/// What the place shows, in the words of a counter-example: the call that has not come back, with what it was given, or
/// else what the worker is at.
[[nodiscard]] CounterExample example_at(const Place& place, std::string check, std::string what);

}  // namespace rmac::verifier
