#include "canopen/watch/node_record.hpp"

#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/fieldbus/canopen/sdo_step.hpp"

namespace rmac::fieldbus::canopen {

void NodeRecord::forget() noexcept {
  emergencies_.forget();
  aborts_.forget();
  for (Tally* tally : {&missed_, &lost_, &recovered_}) tally->set(0);
  jitter_.forget();
}

void NodeRecord::emergency(const CanFrame& frame, std::chrono::nanoseconds since_start) noexcept {
  const auto ms = static_cast<std::uint64_t>(std::chrono::floor<std::chrono::milliseconds>(since_start).count());
  const std::uint64_t error_register = frame.size > 2 ? frame.data[2] : 0;
  emergencies_.note(ms << 24U | error_register << 16U | word_at(frame.data.data()));
}

void NodeRecord::sdo_answer(const CanFrame& frame) noexcept {
  if (frame.size != SdoBytes().size() || frame.data[0] != sdo_command::kAbort) return;
  aborts_.note(std::uint64_t{word_at(&frame.data[1])} << 40U | std::uint64_t{frame.data[3]} << 32U |
               long_at(&frame.data[4]));
}

NodeReport NodeRecord::report(std::chrono::nanoseconds since_start) const {
  NodeReport told;
  told.state = state_.load(std::memory_order_relaxed);
  told.lost = lost_.get();
  told.recovered = recovered_.get();
  told.missed_answers = missed_.get();
  told.answers = jitter_.count();
  told.jitter_mean_s = jitter_.mean_s();
  told.jitter_most_s = jitter_.most_s();
  told.emergency_count = emergencies_.count();
  for (const std::uint64_t word : emergencies_.latest()) {
    const auto code = static_cast<std::uint16_t>(word);
    const std::chrono::duration<double> age = since_start - std::chrono::milliseconds(word >> 24U);
    told.emergencies.push_back(
        {code, emergency_text(code), static_cast<std::uint8_t>(word >> 16U), std::max(age.count(), 0.0)});
  }
  told.abort_count = aborts_.count();
  for (const std::uint64_t word : aborts_.latest()) {
    const ObjectAddress object{static_cast<std::uint16_t>(word >> 40U), static_cast<std::uint8_t>(word >> 32U)};
    const auto code = static_cast<std::uint32_t>(word);
    told.aborts.push_back({object, code, sdo_abort_text(code)});
  }
  return told;
}

}  // namespace rmac::fieldbus::canopen
