#include "gateway/reconfiguration/mechanism_change.hpp"

#include <fmt/format.h>

#include "gateway/mechanism/device_check.hpp"
#include "gateway/mechanism/standing.hpp"

namespace rmac::gateway {

MechanismChange::MechanismChange(MechanismSlot& slot, MotionSupervisor& supervisor, const Assembler& assembler,
                                 BusRegistry& registry, MechanismUsers& users, ToolRack& rack, bool simulated)
    : slot_(slot),
      supervisor_(supervisor),
      assembler_(assembler),
      registry_(registry),
      users_(users),
      rack_(rack),
      simulated_(simulated) {}

Expected<> MechanismChange::put_in(const sdk::DeviceObject& device, const MechanismSource& source, bool fresh) {
  const bool role = fresh && takes_role(device);
  const Frames frames_before = supervisor_.wishes().frames;
  if (role) users_.keep_mounted();  // before the table is read that says so
  auto tools = rack_.read(device.machine());
  if (!tools) return tl::unexpected(tools.error());

  auto before = slot_.predecessor();
  const bool alone = fresh && before && !source.virtual_mode && registry_.runs_otherwise(device);
  if (alone) {
    if (auto left = leave_interfaces(device, source, *before); !left) return left;
  }
  auto candidate = assemble(device, source, fresh);
  if (!candidate) {
    if (alone) return tl::unexpected(slot_.undo(std::move(before), candidate.error()));
    registry_.stop_unused();
    return tl::unexpected(candidate.error());
  }
  if (auto works = put_to_work(std::move(*candidate), fresh); !works) {
    return tl::unexpected(slot_.undo(std::move(before), works.error()));
  }

  slot_.set_folder(source.folder);
  if (fresh && !role) begin_anew(device.name);
  if (fresh) adopt_tools(device, std::move(*tools), source.virtual_mode);
  slot_.settle(std::move(before), fresh,
               fmt::format("{} is {}{}", device.name, fresh ? "loaded" : "configured",
                           source.virtual_mode ? " in virtual mode" : ""));
  if (role) supervisor_.set_frames(frames_before);
  return {};
}

Expected<> MechanismChange::leave_interfaces(const sdk::DeviceObject& device, const MechanismSource& source,
                                             MechanismSlot::Predecessor& before) {
  const ModuleLoader loader = assembler_.loader(source.folder);
  auto may = check_device(device)
                 .and_then([&] { return registry_.check_control_interface(device.digital_control_interface, loader); })
                 .and_then([&] {
                   const bool io = !device.digital_io_interface.name.empty();
                   return io ? registry_.check_io_interface(device.digital_io_interface, loader) : Expected<>();
                 });
  if (!may) return may;
  if (auto off = slot_.switch_off(); !off) return off;
  before.mechanism.reset();  // whoever borrows an interface keeps it
  slot_.drop(false);
  return {};
}

bool MechanismChange::takes_role(const sdk::DeviceObject& device) const {
  const auto& now = slot_.in_force();
  return now && device.machine() == now->device.machine() && device.name != now->device.name;
}

Expected<MechanismChange::Candidate> MechanismChange::assemble(const sdk::DeviceObject& device,
                                                               const MechanismSource& source, bool fresh) const {
  auto made = assembler_.assemble(device, source);
  if (!made) return tl::unexpected(made.error());
  const auto& now = slot_.in_force();
  const auto standing = now ? standing_after(*now, slot_.standing(), **made) : std::optional<std::vector<double>>{};
  if (standing) {
    if (auto inside = check_standing(device, *standing, fresh); !inside) return tl::unexpected(inside.error());
  }
  return Candidate{std::move(*made), standing.has_value()};
}

Expected<> MechanismChange::put_to_work(Candidate candidate, bool fresh) {
  const auto mechanism = candidate.mechanism;
  if (fresh) {
    supervisor_.wish([](ServoWishes& wishes) { wishes.spindle_rpm.fill(0); });
  }
  const bool drives_are_off = slot_.in_force() == nullptr;
  const auto power_on = [&] { return drives_are_off ? slot_.power_on_anew() : slot_.power_on(); };
  return slot_.put_in(mechanism, !fresh).and_then(power_on).and_then([&] {
    return candidate.standing_checked ? Expected<>{} : check_standing(mechanism->device, slot_.standing(), true);
  });
}

void MechanismChange::begin_anew(const std::string& name) {
  supervisor_.wish([](ServoWishes& wishes) { wishes.outputs = 0; });
  supervisor_.set_frames({});
  supervisor_.parking().drop(name + " was loaded anew");
}

void MechanismChange::adopt_tools(const sdk::DeviceObject& device, ToolTable table, bool virtual_mode) {
  const auto keeps = !virtual_mode ? ToolRack::Keeps::Everything
                     : simulated_  ? ToolRack::Keeps::Nothing
                                   : ToolRack::Keeps::Tools;
  users_.keep_mounted();  // what the mechanism before has
  rack_.adopt(device.machine(), std::move(table), keeps);
}

}  // namespace rmac::gateway
