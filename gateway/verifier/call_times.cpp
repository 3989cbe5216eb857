#include "gateway/verifier/call_times.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::verifier {

CallTimes::Count& CallTimes::count_of(std::string_view call) noexcept {
  const auto is_it = [&](const Count& count) { return count.call == call || count.call.empty(); };
  const auto at = std::find_if(counts_.begin(), counts_.end() - 1, is_it);
  at->call = call;
  return *at;
}

std::string CallTimes::complaint(Count& count, std::chrono::nanoseconds least) {
  ++count.slow;
  const double took_us = std::chrono::duration<double, std::micro>(least).count();
  if (least > kWorst) {
    return fmt::format("it takes {:.0f} us of CPU time at the quickest of {} times; {} us are allowed at worst,",
                       took_us, kRepetitions, kWorst.count());
  }
  if (count.calls < kEnough || 2 * count.slow <= count.calls) return "";
  return fmt::format(
      "{} of {} calls take more than {} us of CPU time, this one {:.0f} us; that is allowed as the median,", count.slow,
      count.calls, kMedian.count(), took_us);
}

}  // namespace rmac::verifier
