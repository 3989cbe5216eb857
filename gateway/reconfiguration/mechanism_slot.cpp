#include "gateway/reconfiguration/mechanism_slot.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::gateway {

MechanismSlot::MechanismSlot(MotionSupervisor& supervisor, ServoRequests& servo, const Assembler& assembler,
                             BusRegistry& registry, MechanismUsers& users)
    : supervisor_(supervisor),
      servo_(servo),
      assembler_(assembler),
      registry_(registry),
      users_(users),
      power_(supervisor, servo) {}

std::vector<double> MechanismSlot::standing() const {
  const ServoStatus now = servo_.status();
  return {now.position_set.begin(), now.position_set.begin() + now.joint_count_with_held};
}

Expected<> MechanismSlot::require_sound(const char* what) {
  const CycleState state = supervisor_.state();
  if (!is_faulted(state)) return {};
  return failure(MinorCode::Other,
                 fmt::format("{}: the machine is {}; remove the cause and reset first", what, to_string(state)));
}

Expected<> MechanismSlot::require_rest(const char* what) {
  return require_sound(what).and_then([&] { return supervisor_.require_rest(what); });
}

Expected<> MechanismSlot::put_in(std::shared_ptr<Mechanism> next, bool keep_running) {
  if (auto swapped = servo_.swap(next.get(), generation_ + 1); !swapped) return swapped;
  ++generation_;
  in_force_ = next;
  const auto old = supervisor_.install(std::move(next), generation_, keep_running);
  if (!servo_.wait_for_status([this](const ServoStatus& now) { return now.generation == generation_; })) {
    return failure(MinorCode::ResponseTimeout, "the servo thread does not report on the mechanism that was put in");
  }
  return {};
}

Expected<> MechanismSlot::switch_off() {
  power_.off();
  return servo_.swap(nullptr, generation_ + 1).map([this] {
    ++generation_;
    (void)supervisor_.install(nullptr, generation_, false);
  });
}

void MechanismSlot::drop(bool fresh) {
  users_.mechanism_changed(nullptr, fresh);
  in_force_.reset();
  registry_.stop_unused();
}

Expected<> MechanismSlot::unload() {
  if (!in_force_) return {};
  if (!is_faulted(supervisor_.state())) {
    if (auto rest = supervisor_.require_rest("unloading"); !rest) return rest;
  }
  supervisor_.wish([](ServoWishes& wishes) { wishes.outputs = 0; });
  const std::string name = in_force_->device.name;
  if (auto off = switch_off(); !off) return off;
  users_.keep_mounted();
  supervisor_.parking().drop(name + " was unloaded");
  drop(true);
  users_.draft_from(nullptr);
  report(name + " is unloaded");
  return {};
}

void MechanismSlot::abandon() {
  in_force_.reset();
  (void)supervisor_.install(nullptr, ++generation_, false);
  registry_.stop_unused();
}

std::optional<MechanismSlot::Predecessor> MechanismSlot::predecessor() const {
  if (!in_force_) return {};
  return Predecessor{in_force_, in_force_->device, {folder_, in_force_->virtual_mode()}, {}};
}

void MechanismSlot::settle(std::optional<Predecessor> gone, bool fresh, const std::string& message) {
  bound_spindles();
  users_.mechanism_changed(&in_force_->device, fresh);
  users_.draft_from(&in_force_->device);
  gone.reset();
  registry_.stop_unused();
  report(message);
}

Error MechanismSlot::undo(std::optional<Predecessor> before, const Error& why) {
  Error error = why;
  if (before && (!before->mechanism || before->mechanism != in_force_)) {
    const auto back = put_back(*before);
    error.message += back
                         ? fmt::format("; {} is in force again{}", before->device.name, before->over)
                         : fmt::format("; and {} could not be put back: {}", before->device.name, back.error().message);
  } else if (!before && in_force_) {
    if (auto out = unload(); !out) {
      error.message += "; and it could not be taken out again: " + out.error().message;
    } else {
      leave_fault();
    }
  }
  users_.mechanism_changed(in_force_ ? &in_force_->device : nullptr, false);
  before.reset();
  registry_.stop_unused();
  return error;
}

Expected<> MechanismSlot::put_back(const Predecessor& before) {
  // The loop that was in force has handed its drives over and cannot take them back; one like it can.
  auto again = assembler_.assemble(before.device, before.source);
  if (!again) return tl::unexpected(again.error());
  return put_in(std::move(*again), false)
      .and_then([this] { return clear_fault(); })
      .and_then([this] { return power_on(); })
      .map([this] { leave_fault(); });
}

Expected<> MechanismSlot::power_on_anew() {
  auto on = power_on();
  const ServoFault fault = servo_.status().fault;
  // A drive's fault of its encoder is told as the loss of a sensor.
  const bool drives = fault.kind == ServoFault::Kind::DriveFault ||
                      (fault.kind == ServoFault::Kind::SensorLost && fault.part != ServoFault::Part::Joint);
  if (on || !drives) return on;
  return clear_fault().and_then([this] { return power_on(); }).map([this] { leave_fault(); });
}

void MechanismSlot::leave_fault() {
  (void)supervisor_.command([](CycleSequencer& cycle, const CycleObservation&) {
    return is_faulted(cycle.state()) ? cycle.reset() : Expected<>{};
  });
}

void MechanismSlot::bound_spindles() {
  const auto& spindles = in_force_->device.spindles;
  supervisor_.wish([&](ServoWishes& wishes) {
    for (std::size_t i = 0; i < kMaxSpindles; ++i) {
      const double bound = i < spindles.size() ? spindles[i].max_speed_rpm : 0;
      wishes.spindle_rpm[i] = std::clamp(wishes.spindle_rpm[i], -bound, bound);
    }
  });
}

void MechanismSlot::report(const std::string& message) {
  const ServoStatus now = servo_.status();
  supervisor_.report({Event::Kind::Mechanism, now.t_s, 0, message, now.progress.cycle, {}});
}

}  // namespace rmac::gateway
