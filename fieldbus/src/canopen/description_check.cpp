#include "canopen/description_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "canopen/boot_plan.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "canopen/object_list.hpp"
#include "canopen/pdo.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using eds::DeviceDescription;
using eds::ObjectEntry;

constexpr std::uint16_t kFirstDeviceObject = 0x2000;
constexpr std::uint16_t kErrorBehavior = 0x1029;

tl::unexpected<Error> refusal(const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, what);
}

/// "drive.eds:120: 6071h:00 (Target torque)"
std::string named(const DeviceDescription& description, ObjectAddress address, const ObjectEntry& entry) {
  return fmt::format("{}: {}{}", description.place_of(entry), to_string(address),
                     entry.name.empty() ? "" : fmt::format(" ({})", entry.name));
}

tl::unexpected<Error> absent(const DeviceDescription& description, ObjectAddress address, const char* wanted_for) {
  return refusal(
      fmt::format("{}: the device has no {}, which is {}", description.file, to_string(address), wanted_for));
}

bool is_setpoint(ObjectAddress address) {
  return std::any_of(kSetpointWords.begin(), kSetpointWords.end(),
                     [&](const MappedObject& word) { return word.object == address; });
}

/// A data type, which fills room. A file without [DummyUsage] does not say which the drive can do.
Expected<> check_dummy(const DeviceDescription& description, ObjectAddress address) {
  const auto found = description.dummies.find(address.index);
  if (found == description.dummies.end() || found->second.mappable) return {};
  return refusal(named(description, address, found->second) + " cannot fill room in a PDO");
}

Expected<> check_mapped(const DeviceDescription& description, const MappedObject& object, std::uint16_t offset,
                        bool setpoint) {
  if (object.object.index < kFirstObject) return check_dummy(description, object.object);
  const ObjectAddress address = of_axis(object.object, offset);
  const ObjectEntry* entry = description.find(address);
  if (entry == nullptr) return absent(description, address, setpoint ? "mapped by rpdo" : "mapped by tpdo");
  const std::string at = named(description, address, *entry);
  if (!entry->mappable) return refusal(at + " cannot be mapped into a PDO (PDOMapping)");
  if (setpoint ? !settable_by_pdo(entry->access) : !tellable_by_pdo(entry->access)) {
    return refusal(at + (setpoint ? " cannot be set by a PDO (AccessType)" : " cannot be told by a PDO (AccessType)"));
  }
  if (const unsigned bits = bits_of(entry->type); bits != 0 && bits != object.bits) {
    return refusal(fmt::format("{} has {} bits, and {} are mapped", at, bits, object.bits));
  }
  return {};
}

/// Whether `number` is beyond a limit of the file. Numbers that fill their whole type are compared without sign.
bool beyond(const ObjectEntry& entry, std::uint8_t node, std::int64_t number) {
  const auto before = [&](std::int64_t a, std::int64_t b) {
    return is_signed(entry.type) ? a < b : static_cast<std::uint64_t>(a) < static_cast<std::uint64_t>(b);
  };
  return (entry.least && before(number, entry.least->number_for(node, entry.type))) ||
         (entry.most && before(entry.most->number_for(node, entry.type), number));
}

Expected<> check_written(const DeviceDescription& description, const BootStep& step, std::uint8_t node) {
  const ObjectEntry* entry = description.find(step.object);
  if (entry == nullptr) {
    if (step.optional) return {};
    return absent(description, step.object, "written at boot");
  }
  const std::string at = named(description, step.object, *entry);
  if (!writable(entry->access)) return refusal(at + " cannot be written, and it would be at boot (AccessType)");
  const std::size_t bytes = bytes_of(entry->type);
  if (bytes != 0 && bytes != step.bytes.size()) {
    return refusal(fmt::format("{} has {} bytes, and {} would be written", at, bytes, step.bytes.size()));
  }
  if (bytes == 0 || is_real(entry->type)) return {};
  const std::int64_t number = eds::Value{step.bytes}.number_for(0, entry->type);
  if (beyond(*entry, node, number)) {
    return refusal(fmt::format("{} would be set to {}, which is beyond its limits in the file", at, number));
  }
  return {};
}

}  // namespace

std::vector<SdoWrite> configured_writes(const DeviceDescription& description, std::uint8_t node) {
  std::vector<SdoWrite> writes;
  for (const auto& [address, entry] : description.entries) {
    const bool masters_own = address.index < kFirstDeviceObject && address.index != kErrorBehavior;
    if (!entry.configured || masters_own || is_setpoint(address) || !writable(entry.access)) continue;
    if (entry.configured->bytes.empty()) continue;  // a domain, whose value is the name of another file
    writes.push_back({address, entry.configured->bytes_for(node)});
  }
  return writes;
}

std::string configured_mapping(const eds::DeviceDescription& description, std::uint16_t mapping_index,
                               std::uint8_t axis_in_node) {
  const auto contents = static_cast<std::uint16_t>(mapping_index + kPdoOffset * axis_in_node);
  const ObjectEntry* count = description.find({contents, 0});
  if (count == nullptr || !count->configured) return {};
  const std::int64_t entries = count->configured->number_for(0, count->type);
  std::string text;
  constexpr std::uint8_t kMostEntries = 64;
  for (std::uint8_t sub = 1; sub <= entries && sub <= kMostEntries; ++sub) {
    const ObjectEntry* entry = description.find({contents, sub});
    if (entry == nullptr) break;
    const auto& value = entry->configured ? entry->configured : entry->initial;
    if (!value) break;
    const auto mapped = static_cast<std::uint32_t>(value->number_for(0, entry->type));
    const std::uint32_t index = mapped >> 16;
    const bool of_profile = index >= kFirstProfileObject;
    text += fmt::format("{:04X}:{:02X}/{} ", of_profile ? index - kAxisOffset * axis_in_node : index,
                        mapped >> 8 & 0xFFU, mapped & 0xFFU);
  }
  return text;
}

Expected<> check_description(const CanopenConfig& config, const AxisConfig& axis) {
  if (!axis.description) return {};
  const DeviceDescription& description = *axis.description;
  if (description.node && *description.node != axis.node) {
    return refusal(fmt::format("{} configures node {}, not node {}", description.file, *description.node, axis.node));
  }
  if (description.bit_rate && *description.bit_rate != config.bit_rate) {
    return refusal(fmt::format("{} configures {} bit/s, and bit_rate is {}", description.file, *description.bit_rate,
                               config.bit_rate));
  }
  if (!description.bit_rates.empty() && !description.bit_rates.contains(config.bit_rate)) {
    return refusal(fmt::format("{}: the device does not know {} bit/s; it knows {}", description.file, config.bit_rate,
                               fmt::join(description.bit_rates, ", ")));
  }
  const auto offset = static_cast<std::uint16_t>(kAxisOffset * axis.axis_in_node);
  for (const MappedObject& object : together(axis.setpoints, axis.more_setpoints)) {
    if (auto fits = check_mapped(description, object, offset, true); !fits) return fits;
  }
  for (const MappedObject& object : together(axis.answers, axis.more_answers)) {
    if (auto fits = check_mapped(description, object, offset, false); !fits) return fits;
  }
  for (const BootStep& step : boot_plan(config, axis.node, chosen_drive(config, axis.node))) {
    if (step.kind != BootStep::Kind::Write) continue;
    if (auto fits = check_written(description, step, axis.node); !fits) return fits;
  }
  return {};
}

}  // namespace rmac::fieldbus::canopen
