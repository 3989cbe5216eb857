#include "gateway/reconfiguration/interface_change.hpp"

#include <fmt/format.h>

#include "gateway/mechanism/device_check.hpp"
#include "gateway/mechanism/standing.hpp"

namespace rmac::gateway {

bool InterfaceChange::needed(const sdk::DeviceObject& device, const MechanismSource& source) const {
  const auto& now = slot_.in_force();
  return now && !source.virtual_mode && now->device.digital_control_interface != device.digital_control_interface;
}

Expected<> InterfaceChange::put_in(const sdk::DeviceObject& device, const MechanismSource& source) {
  auto may = check_device(device).and_then([&] {
    return registry_.check_control_interface(device.digital_control_interface, assembler_.loader(source.folder));
  });
  if (!may) return may;
  auto before = slot_.predecessor();
  before->over = " over " + before->device.digital_control_interface.name;
  before->mechanism.reset();  // whoever borrows a bus keeps it: nobody may hold the mechanism in force now
  auto done = slot_.switch_off();
  slot_.drop(false);
  if (done) done = bring_up(device, source);
  if (!done) {
    if (slot_.in_force()) {
      (void)slot_.switch_off();
      slot_.drop(false);
    }
    return tl::unexpected(slot_.undo(std::move(before), done.error()));
  }
  slot_.settle({}, false, fmt::format("{} is configured over {}", device.name, device.digital_control_interface.name));
  return {};
}

Expected<> InterfaceChange::bring_up(const sdk::DeviceObject& device, const MechanismSource& source) {
  return assembler_.assemble(device, source)
      .and_then([&](std::shared_ptr<Mechanism> next) { return slot_.put_in(std::move(next), false); })
      .and_then([&] { return slot_.power_on(); })
      .and_then([&] { return check_standing(device, slot_.standing(), true); });
}

}  // namespace rmac::gateway
