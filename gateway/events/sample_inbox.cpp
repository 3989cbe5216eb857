#include "gateway/events/sample_inbox.hpp"

#include <algorithm>

namespace rmac::gateway {

void SampleInbox::take_over() {
  // No further than now: in virtual time the servo thread could go on as fast as it is followed.
  const std::int64_t newest = link_.history.newest();
  CycleSample sample;
  for (auto cycle = std::max(link_.delivered.load() + 1, link_.history.oldest()); cycle <= newest; ++cycle) {
    if (link_.history.read(cycle, sample)) waiting_.push_back(sample);
  }
  link_.delivered.store(newest);
}

std::optional<CycleSample> SampleInbox::next(std::int64_t last_cycle) {
  if (waiting_.empty() || waiting_.front().cycle > last_cycle) return {};
  const CycleSample sample = waiting_.front();
  waiting_.pop_front();
  return sample;
}

}  // namespace rmac::gateway
