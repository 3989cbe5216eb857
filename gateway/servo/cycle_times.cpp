#include "gateway/servo/cycle_times.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::gateway {

std::int64_t TimeCounts::quantile_ns(double part) const noexcept {
  const auto wanted = static_cast<std::uint64_t>(std::ceil(part * static_cast<double>(count)));
  std::uint64_t passed = 0;
  for (std::size_t bin = 0; bin < kBins && count > 0; ++bin) {
    passed += bins[bin];
    if (passed >= wanted && passed > 0) return std::min(end_of(bin), largest_ns);
  }
  return largest_ns;
}

void TimeHistogram::clear() noexcept {
  for (auto& bin : bins_) bin.store(0, std::memory_order_relaxed);
  largest_ns_.store(0, std::memory_order_relaxed);
}

TimeCounts TimeHistogram::read() const noexcept {
  TimeCounts result;
  for (std::size_t bin = 0; bin < TimeCounts::kBins; ++bin) {
    result.bins[bin] = bins_[bin].load(std::memory_order_relaxed);
    result.count += result.bins[bin];
  }
  result.largest_ns = largest_ns_.load(std::memory_order_relaxed);
  return result;
}

}  // namespace rmac::gateway
