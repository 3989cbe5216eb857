#include "gateway/dynamics/closed_loops.hpp"

#include <algorithm>

#include "gateway/buses/built_in_interfaces.hpp"
#include "gateway/events/fault_text.hpp"
#include "gateway/mechanism/assembler.hpp"

namespace rmac::gateway {

Expected<std::unique_ptr<ClosedLoops>> ClosedLoops::assemble(const sdk::DeviceObject& device, const Options& options,
                                                             const ModuleLoader& loader) {
  sdk::DeviceObject without_io = device;
  without_io.digital_io_interface = {};
  without_io.inputs.clear();
  without_io.drive_inputs.clear();
  without_io.outputs.clear();
  std::unique_ptr<ClosedLoops> loops(new ClosedLoops(options));
  add_built_in_interfaces(loops->registry_, options.period_s);
  auto mechanism = gateway::assemble(without_io, {.virtual_mode = options.virtual_mode, .period_s = options.period_s},
                                     loader, loops->registry_);
  if (!mechanism) return tl::unexpected(mechanism.error());
  loops->mechanism_ = std::move(*mechanism);
  return loops;
}

Expected<> ClosedLoops::power_up() {
  constexpr double kPatience_s = 20;
  command.power = true;
  while (!report_.follows) {
    if (static_cast<double>(cycles_) * options_.period_s > kPatience_s) {
      return failure(MinorCode::Other, "the drives do not come up within 20 s");
    }
    if (!cycle()) return failure(MinorCode::Other, fault_text());
    hold_still();
  }
  return {};
}

void ClosedLoops::hold_still() {
  const ServoLoop& loop = *mechanism_->loop;
  const auto hold = loop.hold_position();
  std::copy_n(hold.begin(), loop.joint_count(), command.setpoint.position.begin());
  command.setpoint.velocity.fill(0);
  command.setpoint.acceleration.fill(0);
}

bool ClosedLoops::cycle() {
  if (options_.before_cycle) options_.before_cycle();
  mechanism_->loop->cycle(command, report_);
  ++cycles_;
  return report_.fault.kind == ServoFault::Kind::None;
}

std::string ClosedLoops::fault_text() const {
  return describe(report_.fault, mechanism_.get());
}

}  // namespace rmac::gateway
