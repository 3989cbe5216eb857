#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string_view>

#include "gateway/buses/simulated_io.hpp"
#include "gateway/mechanism/loop_draft.hpp"

namespace rmac::gateway {
namespace {

/// Names of inputs on which the servo loop acts by itself.
constexpr std::string_view kEmergencyStop = "EmergencyStop", kLimit = "Limit";
/// Names of those that a touch probe is wired to.
constexpr const char *kProbe = "Probe", *kProbeReady = "ProbeReady";

std::uint64_t named(const std::map<std::string, int>& names, std::string_view prefix) {
  std::uint64_t bits = 0;
  for (const auto& [name, bit] : names) bits |= name.starts_with(prefix) ? std::uint64_t{1} << bit : 0;
  return bits;
}

Expected<> check_bits(const std::map<std::string, int>& names, const std::string& what, std::uint64_t there,
                      const std::string& interface) {
  for (const auto& [name, bit] : names) {
    if ((there >> bit & 1U) != 0) continue;
    std::vector<int> bits;
    for (int i = 0; i < 64; ++i) {
      if ((there >> i & 1U) != 0) bits.push_back(i);
    }
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{} \"{}\" is bit {}, to which nothing of {} is connected; connected are {}", what, name,
                               bit, interface, bits.empty() ? "none" : fmt::format("{}", fmt::join(bits, ", "))));
  }
  return {};
}

Expected<> add_io_interface(LoopDraft& draft) {
  const sdk::DeviceObject& device = draft.device;
  if (device.digital_io_interface.name.empty()) return {};
  auto io = draft.registry.acquire_io(device.digital_io_interface, draft.loader);
  if (!io) return tl::unexpected(io.error());
  const std::string& name = device.digital_io_interface.name;
  auto inputs = device.inputs;
  std::erase_if(inputs, [&](const auto& input) { return device.drive_inputs.contains(input.second); });
  auto connected = check_bits(inputs, "input", (*io)->input_bits(), name).and_then([&] {
    return check_bits(device.outputs, "output", (*io)->output_bits(), name);
  });
  if (!connected) return connected;
  auto probed = with_touch_probe(std::move(*io), draft.parts);
  if (!probed) return tl::unexpected(probed.error());
  draft.parts.io = std::move(*probed);
  return {};
}

Expected<> add_drive_inputs(const sdk::DeviceObject& device, ServoLoopParts& parts) {
  for (const auto& [name, at] : device.inputs) {
    const auto told = device.drive_inputs.find(at);
    if (told == device.drive_inputs.end()) continue;
    const auto [actuator, bit] = told->second;
    if (actuator >= parts.actuators.size()) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("input \"{}\" is of actuator {}, and there are {}",
                                                                   name, actuator, parts.actuators.size()));
    }
    const ServoActuator& drive = parts.actuators[actuator];
    auto told_there = check_bits({{name, bit}}, fmt::format("input of actuator {}", actuator),
                                 drive.bus->interface->input_bits(drive.axis), "its drive's interface");
    if (!told_there) return told_there;
    parts.drive_inputs.push_back(
        {static_cast<std::uint32_t>(actuator), std::uint32_t{1} << bit, std::uint64_t{1} << at});
  }
  return {};
}

/// Switches whose names say the joint and the end: LimitXNegative, LimitXPositive.
std::vector<ServoLimit> limits_of(const sdk::DeviceObject& device) {
  std::vector<ServoLimit> limits;
  const auto add = [&](const std::string& joint, std::uint32_t number) {
    for (const auto& [end, direction] : {std::pair{"Negative", -1}, std::pair{"Positive", 1}}) {
      const auto found = device.inputs.find(fmt::format("{}{}{}", kLimit, joint, end));
      if (found != device.inputs.end()) limits.push_back({std::uint64_t{1} << found->second, number, direction});
    }
  };
  for (std::size_t j = 0; j < device.joint_count_with_held(); ++j) {
    add(joint_at(device, j).limits.name, static_cast<std::uint32_t>(j));
  }
  return limits;
}

}  // namespace

Expected<> add_io(LoopDraft& draft) {
  const sdk::DeviceObject& device = draft.device;
  ServoLoopParts& parts = draft.parts;
  if (parts.virtual_mode) return {};
  auto added = add_io_interface(draft).and_then([&] { return add_drive_inputs(device, parts); });
  if (!added) return added;
  parts.limits = limits_of(device);
  parts.emergency_stop_inputs = named(device.inputs, kEmergencyStop);
  parts.limit_inputs = named(device.inputs, kLimit);
  const auto bit = [&](const char* input) {
    const auto found = device.inputs.find(input);
    return found == device.inputs.end() ? 0 : std::uint64_t{1} << found->second;
  };
  parts.probe = {bit(kProbe), bit(kProbeReady), device.probing.settle_time_s};
  return {};
}

}  // namespace rmac::gateway
