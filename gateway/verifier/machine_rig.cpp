#include "gateway/verifier/machine_rig.hpp"

#include <algorithm>

#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/events/fault_text.hpp"
#include "gateway/mechanism/assembler.hpp"

namespace rmac::verifier {

tl::expected<std::unique_ptr<MachineRig>, CounterExample> MachineRig::assemble(const Task& task,
                                                                               const sdk::DeviceObject& device,
                                                                               bool virtual_mode, Watch& watch) {
  sdk::DeviceObject without_io = device;
  without_io.digital_io_interface = {};
  without_io.inputs.clear();
  without_io.drive_inputs.clear();
  without_io.outputs.clear();
  std::unique_ptr<MachineRig> rig(new MachineRig(watch));
  gateway::add_built_in_interfaces(rig->registry_, kPeriod_s);
  watch.step("assembling");
  auto mechanism =
      gateway::assemble(without_io, {.virtual_mode = virtual_mode, .period_s = kPeriod_s}, task.loader, rig->registry_);
  if (!mechanism) return found("assembling", mechanism.error().message, -1, {});
  rig->mechanism_ = std::move(*mechanism);
  return rig;
}

Checked MachineRig::power_up() {
  constexpr int kMostCycles = 20'000;
  command.power = true;
  for (int i = 0; !report_.follows; ++i) {
    if (i == kMostCycles) return found("power", "the drives do not come up within 20 s", -1, {});
    if (auto fine = cycle(); !fine) return fine;
    hold_still();
  }
  return {};
}

void MachineRig::hold_still() {
  const ServoLoop& loop = *mechanism_->loop;
  const auto hold = loop.hold_position();
  std::copy_n(hold.begin(), loop.joint_count(), command.setpoint.position.begin());
  command.setpoint.velocity.fill(0);
  command.setpoint.acceleration.fill(0);
}

Checked MachineRig::cycle() {
  watch_.step("a servo cycle on the axis models");
  mechanism_->loop->cycle(command, report_);
  ++cycles_;
  if (report_.fault.kind == ServoFault::Kind::None) return {};
  return fault("stability",
               "on the model of its axes, where encoders are sound and nothing is in the way, which leaves "
               "the gains (docs/servo.md, Tuning an axis): " +
                   gateway::describe(report_.fault, mechanism_.get()));
}

tl::unexpected<CounterExample> MachineRig::fault(const char* check, std::string what) const {
  const auto shown = [&](const char* name, const auto& values) {
    return named(name, std::span(values).first(mechanism_->loop->joint_count_with_held()));
  };
  return found(
      check, std::move(what), cycles_,
      {shown("setpoint", report_.position_set), shown("position", report_.position), shown("effort", report_.effort)});
}

}  // namespace rmac::verifier
