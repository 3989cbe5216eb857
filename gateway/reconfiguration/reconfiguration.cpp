#include "gateway/reconfiguration/reconfiguration.hpp"

#include <fmt/format.h>

namespace rmac::gateway {

Reconfiguration::Reconfiguration(const Parts& parts, std::function<void()> meanwhile, bool simulated)
    : supervisor_(parts.supervisor),
      users_(parts.users),
      servo_(parts.link, std::move(meanwhile)),
      slot_(parts.supervisor, servo_, parts.assembler, parts.registry, parts.users),
      mechanism_change_(slot_, parts.supervisor, parts.assembler, parts.registry, parts.users, parts.rack, simulated),
      interface_change_(slot_, parts.assembler, parts.registry),
      loop_change_(slot_, servo_, parts.assembler, parts.users),
      learning_(slot_, servo_, parts.supervisor) {}

Expected<> Reconfiguration::put_in(const sdk::DeviceObject& device, const MechanismSource& source, bool fresh) {
  if (auto ready = slot_.require_rest("putting in a configuration"); !ready) return ready;
  learning_.forget();
  if (!fresh && interface_change_.needed(device, source)) return interface_change_.put_in(device, source);
  return mechanism_change_.put_in(device, source, fresh);
}

Expected<> Reconfiguration::change_loops(const sdk::DeviceObject& device, const MechanismSource& source) {
  const std::vector<std::size_t> joints = loop_change_.joints(device);
  if (joints.empty()) return put_in(device, source, false);
  if (auto fine = loop_change_.check(device); !fine) return fine;
  // At rest a joint that has slipped takes its place along.
  if (loop_change_.changes_method(device, joints) && supervisor_.require_rest("another control method")) {
    return put_in(device, source, false);
  }
  learning_.forget();
  return loop_change_.exchange(device, joints);
}

Expected<> Reconfiguration::unload() {
  return slot_.unload().map([this] { learning_.forget(); });
}

Expected<> Reconfiguration::reset() {
  const CycleState state = supervisor_.state();
  if (!is_faulted(state)) {
    auto taken_over = supervisor_.operating().take_over();
    if (!taken_over) return tl::unexpected(taken_over.error());
    if (*taken_over) return {};
    return failure(MinorCode::Other,
                   fmt::format("reset: there is no fault to reset, the machine is {}", to_string(state)));
  }
  const auto before = slot_.in_force();
  if (before && servo_.status().state == ServoState::Faulted) {
    if (auto cleared = slot_.clear_fault(); !cleared) return cleared;
  }
  if (before) {
    // What was planned begins where the machine no longer is.
    if (auto emptied = slot_.put_in(before->with_empty_path(), true); !emptied) return emptied;
    users_.mechanism_changed(device(), false);
  }
  auto left = supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.reset(); });
  (void)supervisor_.operating().take_over();  // an operator who is there keeps what they held
  if (left && before) left = slot_.power_on();
  return left;
}

void Reconfiguration::come_to_rest() {
  (void)servo_.wait_for([this] {
    const CycleState state = supervisor_.state();
    return state == CycleState::Idle || is_faulted(state);
  });
  (void)unload();
}

}  // namespace rmac::gateway
