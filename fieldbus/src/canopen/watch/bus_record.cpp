#include "canopen/watch/bus_record.hpp"

namespace rmac::fieldbus::canopen {

void BusRecord::note(const CanopenCounters& counters, const CanHealth& health, std::chrono::nanoseconds now) noexcept {
  run_ns_.set(static_cast<std::uint64_t>(since_start(now).count()));
  cycles_.set(counters.cycles);
  unsent_.set(counters.unsent);
  short_answers_.set(counters.short_answers);
  sent_.set(health.sent);
  received_.set(health.received);
  queue_full_.set(health.queue_full);
  send_failures_.set(health.send_failures);
  overflowed_.set(health.overflowed);
  error_frames_.set(health.error_frames);
  warnings_.set(health.warnings);
  passives_.set(health.passives);
  bus_offs_.set(health.bus_offs);
  bus_off_.set(health.bus_off ? 1 : 0);
  link_down_.set(health.link_down ? 1 : 0);
}

BusReport BusRecord::report() const {
  BusReport told;
  told.cycles = cycles_.get();
  told.unsent = unsent_.get();
  told.short_answers = short_answers_.get();
  told.health.sent = sent_.get();
  told.health.received = received_.get();
  told.health.queue_full = queue_full_.get();
  told.health.send_failures = send_failures_.get();
  told.health.overflowed = overflowed_.get();
  told.health.error_frames = error_frames_.get();
  told.health.warnings = warnings_.get();
  told.health.passives = passives_.get();
  told.health.bus_offs = bus_offs_.get();
  told.health.bus_off = bus_off_.get() != 0;
  told.health.link_down = link_down_.get() != 0;
  return told;
}

}  // namespace rmac::fieldbus::canopen
