#include "gateway/verifier/machine_rig.hpp"

#include <span>
#include <utility>

namespace rmac::verifier {
namespace {

/// Simulated axes without the part that their bus may have under the tool: planned moves would go into it.
sdk::DeviceObject without_part(sdk::DeviceObject device) {
  if (device.digital_control_interface.name != "SimulatedInterface") return device;
  std::erase_if(device.digital_control_interface.numbers, [](const auto& parameter) {
    const std::string& name = parameter.first;
    return name.compare(name.rfind('.') + 1, 8, "contact_") == 0;
  });
  return device;
}

}  // namespace

tl::expected<std::unique_ptr<MachineRig>, CounterExample> MachineRig::assemble(const Task& task,
                                                                               const sdk::DeviceObject& device,
                                                                               bool virtual_mode, Watch& watch) {
  watch.step("assembling");
  auto loops =
      gateway::ClosedLoops::assemble(without_part(device),
                                     {.period_s = task.period_s,
                                      .virtual_mode = virtual_mode,
                                      .before_cycle = [&watch] { watch.step("a servo cycle on the axis models"); }},
                                     task.loader);
  if (!loops) return found("assembling", loops.error().message, -1, {});
  return std::unique_ptr<MachineRig>(new MachineRig(std::move(*loops), task.period_s));
}

Checked MachineRig::power_up() {
  const auto up = loops_->power_up();
  if (up) return {};
  if (report().fault.kind != ServoFault::Kind::None) return unstable();
  return found("power", up.error().message, -1, {});
}

Checked MachineRig::cycle() {
  return loops_->cycle() ? Checked() : Checked(unstable());
}

tl::unexpected<CounterExample> MachineRig::unstable() const {
  return fault("stability",
               "on the model of its axes, where encoders are sound and nothing is in the way, which leaves "
               "the gains (docs/servo.md, Tuning an axis): " +
                   loops_->fault_text());
}

tl::unexpected<CounterExample> MachineRig::fault(const char* check, std::string what) const {
  const auto shown = [&](const char* name, const auto& values) {
    return named(name, std::span(values).first(mechanism().loop->joint_count_with_held()));
  };
  return found(check, std::move(what), loops_->cycles(),
               {shown("setpoint", report().position_set), shown("position", report().position),
                shown("effort", report().effort)});
}

}  // namespace rmac::verifier
