#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/rmac/commands/bus/machine_bus.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/object_access.hpp"
#include "rmac/fieldbus/canopen/object_meaning.hpp"
#include "rmac/fieldbus/eds/type_names.hpp"

namespace rmac::cli {
namespace {

namespace canopen = fieldbus::canopen;
namespace eds = fieldbus::eds;
using canopen::ObjectMeaning;

struct SdoOptions {
  std::string interface, object, type, eds;
  std::optional<std::string> value;
  int node = 0;
  MachineChoice machine;
  double timeout_s = 1;
};

/// An object of a node, and what is known of it.
struct Place {
  std::uint8_t node = 0;
  fieldbus::ObjectAddress object;
  ObjectMeaning meaning;
};

/// The data sheet of the node: the one that was named, or the one that the machine has for it. Null: there is none.
Result<std::shared_ptr<const eds::DeviceDescription>> sheet_of(const SdoOptions& options) {
  using Sheet = std::shared_ptr<const eds::DeviceDescription>;
  if (!options.eds.empty()) {
    auto read = eds::read_device_description(options.eds);
    if (!read) return fail(read.error().message);
    return std::make_shared<const eds::DeviceDescription>(std::move(*read));
  }
  if (options.machine.machine.empty()) return Sheet();
  const auto buses = canopen_buses(options.machine);
  if (!buses) return tl::unexpected(buses.error());
  const canopen::CanopenConfig* bus = bus_of_interface(*buses, options.interface);
  if (bus == nullptr) {
    return fail(fmt::format("{} has no CAN bus {}", options.machine.machine, options.interface));
  }
  for (const canopen::AxisConfig& axis : bus->axes) {
    if (axis.node == options.node && axis.description) return axis.description;
  }
  return Sheet();
}

Result<Place> place_of(const SdoOptions& options) {
  const auto object = canopen::read_object_address(options.object);
  if (!object) return fail(object.error().message);
  const auto sheet = sheet_of(options);
  if (!sheet) return tl::unexpected(sheet.error());
  Place place{static_cast<std::uint8_t>(options.node), *object, canopen::meaning_of(*object, sheet->get())};
  if (options.type.empty()) return place;
  place.meaning.type = eds::read_type_name(options.type);
  if (place.meaning.type) return place;
  return fail(fmt::format("\"{}\" is no data type; there are {}, and the standard's names like UNSIGNED16",
                          options.type, eds::short_type_names()));
}

/// An interface on which no machine runs.
Result<std::unique_ptr<fieldbus::SocketCanPort>> open_idle(const std::string& interface) {
  constexpr std::size_t kBurst = 1;
  auto port = fieldbus::SocketCanPort::open(interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  const auto idle = canopen::check_idle(**port, canopen::ScanOptions().listen);
  if (!idle) return fail(fmt::format("{}: {}", interface, idle.error().message));
  return std::move(*port);
}

void show_value(const Place& place, const std::vector<std::uint8_t>& bytes, bool json) {
  if (!json) {
    fmt::print("{} = {}\n", object_text(place.object, place.meaning), value_text(place.object, place.meaning, bytes));
    return;
  }
  nlohmann::json told{{"node", place.node},
                      {"index", place.object.index},
                      {"sub", place.object.sub},
                      {"bytes", bytes},
                      {"text", value_text(place.object, place.meaning, bytes)}};
  std::visit([&](const auto& value) { told["value"] = value; }, canopen::value_of(place.meaning, bytes));
  if (!place.meaning.name.empty()) told["name"] = place.meaning.name;
  if (place.meaning.type) told["type"] = eds::type_name(*place.meaning.type);
  if (!place.meaning.unit.empty()) told["unit"] = place.meaning.unit;
  fmt::print("{}\n", told.dump());
}

std::chrono::nanoseconds timeout_of(const SdoOptions& options) {
  return std::chrono::milliseconds(std::llround(options.timeout_s * 1000));
}

Result<> read_value(const SdoOptions& options, bool json) {
  const auto place = place_of(options);
  if (!place) return tl::unexpected(place.error());
  const auto port = open_idle(options.interface);
  if (!port) return tl::unexpected(port.error());
  const auto bytes = canopen::read_object(**port, place->node, place->object, timeout_of(options));
  if (!bytes) return fail(fmt::format("{}: {}", options.interface, bytes.error().message));
  show_value(*place, *bytes, json);
  return {};
}

Result<> write_value(SdoOptions options, bool json) {
  // TYPE may be left out; the last word is VALUE in any case.
  if (!options.value) options.value = std::exchange(options.type, {});
  const auto place = place_of(options);
  if (!place) return tl::unexpected(place.error());
  if (!place->meaning.type) {
    return fail(fmt::format("the type of {} is unknown here; give it before the value ({}), or the node's --eds",
                            to_string(place->object), eds::short_type_names()));
  }
  const auto bytes = eds::bytes_of_text(*options.value, *place->meaning.type);
  if (!bytes) return fail(bytes.error().message);
  const auto port = open_idle(options.interface);
  if (!port) return tl::unexpected(port.error());
  auto done = canopen::check_moves_nothing(**port, place->node, place->object, *bytes);
  if (done) done = canopen::write_object(**port, place->node, place->object, *bytes, timeout_of(options));
  if (!done) return fail(fmt::format("{}: {}", options.interface, done.error().message));
  show_value(*place, *bytes, json);
  return {};
}

/// What both commands take first, and the options.
void add_place(Command& command, SdoOptions& options) {
  command.option("INTERFACE", &options.interface, kInterfaceMeaning).required();
  command.option("NODE", &options.node, "its node id").required().within(1, 127);
  command.option("INDEX:SUB", &options.object, "the object, in hexadecimal: 6041:00, 0x6041:0 or 6041h").required();
}

void add_options(Command& command, SdoOptions& options) {
  command.option("--eds", &options.eds, "the node's EDS or DCF file: names and types").excludes({"--machine"});
  command.option("--timeout", &options.timeout_s, "s that each answer of the node may take")
      .within(0.001, 60.0)
      .shows_default();
}

}  // namespace

void add_bus_sdo(Command& bus) {
  Command sdo = bus.add("sdo", "read and write objects of a node; refuses a bus on which a machine runs");
  sdo.needs_command();
  const auto reading = std::make_shared<SdoOptions>();
  Command reads = sdo.add("read", "tell the value of an object");
  add_place(reads, *reading);
  reads.option("TYPE", &reading->type, "how to read it, unless the EDS or the standard tell: u16, i32, vs, UNSIGNED16");
  add_machine_options(reads, reading->machine);
  add_options(reads, *reading);
  reads.does(without_appliance([reading](bool json) { return read_value(*reading, json); }));

  const auto writing = std::make_shared<SdoOptions>();
  Command writes = sdo.add("write", "change the value of an object; refused while the node's motor has power");
  add_place(writes, *writing);
  writes.option("TYPE", &writing->type, "how to write it, unless the EDS or the standard tell; may be left out")
      .required()
      .may_be_empty();
  writes.option("VALUE", &writing->value, "decimal, hexadecimal behind 0x, text or pairs of hexadecimal digits")
      .may_be_empty();
  add_machine_options(writes, writing->machine);
  add_options(writes, *writing);
  writes.does(without_appliance([writing](bool json) { return write_value(*writing, json); }));
}

}  // namespace rmac::cli
