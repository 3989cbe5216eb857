#pragma once

#include <time.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/threads/cpu_time.hpp"
#include "gateway/threads/sanitized.hpp"

namespace rmac::verifier {

/// How long the calls of a port take, of the thread's CPU time. A call that looks slow by the clock on the wall is made
/// again with the same arguments, and only the quickest of all counts: what else the computer does makes no call slow,
/// and a call that is slow for some arguments alone is found. For ports without state, which may be called again.
class CallTimes {
 public:
  static constexpr std::chrono::microseconds kMedian{20}, kWorst{200};
  static constexpr bool kMeasured = !kSanitized;

  /// Counts a call that took `on_the_wall`; `again` makes it once more. Empty, or what is wrong with it.
  template <typename Again>
  std::string judge(const char* call, std::chrono::nanoseconds on_the_wall, Again&& again) {
    Count& count = count_of(call);
    ++count.calls;
    if (!kMeasured || on_the_wall <= kMedian) return "";
    std::chrono::nanoseconds least = on_the_wall;
    for (int i = 0; i < kRepetitions && least > kMedian; ++i) {
      const auto before = gateway::cpu_time(CLOCK_THREAD_CPUTIME_ID);
      again();
      least = std::min(least, gateway::cpu_time(CLOCK_THREAD_CPUTIME_ID) - before);
    }
    return least > kMedian ? complaint(count, least) : "";
  }

 private:
  static constexpr int kRepetitions = 5;
  static constexpr std::int64_t kEnough = 201;  ///< calls, for a median
  struct Count {
    std::string_view call;
    std::int64_t calls = 0, slow = 0;
  };

  Count& count_of(std::string_view call) noexcept;
  static std::string complaint(Count& count, std::chrono::nanoseconds least);

  std::array<Count, 8> counts_{};  ///< no port has more functions
};

}  // namespace rmac::verifier
