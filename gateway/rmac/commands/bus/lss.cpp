#include "rmac/fieldbus/canopen/lss.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"

namespace rmac::cli {
namespace {

namespace canopen = fieldbus::canopen;
using canopen::Identity;

Result<std::unique_ptr<fieldbus::SocketCanPort>> open_bus(const std::string& interface) {
  constexpr std::size_t kBurst = 8;
  auto port = fieldbus::SocketCanPort::open(interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  return std::move(*port);
}

std::vector<std::string> identity_row(const Identity& identity) {
  const auto hexadecimal = [](std::uint32_t number) { return fmt::format("{:X}h", number); };
  return {hexadecimal(identity.vendor_id), hexadecimal(identity.product_code), hexadecimal(identity.revision_number),
          hexadecimal(identity.serial_number)};
}

/// All nodes of the bus: those with an id by SDO, the others by fast scan.
Expected<std::vector<Identity>> everyone(fieldbus::CanPort& port) {
  auto with_ids = canopen::scan_bus(port);
  if (!with_ids) return tl::unexpected(with_ids.error());
  auto identities = canopen::lss_scan(port);
  if (!identities) return identities;
  for (const canopen::ScannedNode& node : *with_ids) {
    if (!node.answers) {
      return failure(
          MinorCode::CommTimeout,
          fmt::format("node {} does not say who it is, so it cannot be told; switch it off and on", node.node));
    }
    identities->push_back(node.identity);
  }
  return identities;
}

Result<> scan(const std::string& interface, bool json) {
  const auto port = open_bus(interface);
  if (!port) return tl::unexpected(port.error());
  const auto nodes = canopen::lss_scan(**port);
  if (!nodes) return fail(fmt::format("{}: {}", interface, nodes.error().message));
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const Identity& node : *nodes) {
      list.push_back({{"vendor_id", node.vendor_id},
                      {"product_code", node.product_code},
                      {"revision_number", node.revision_number},
                      {"serial_number", node.serial_number}});
    }
    fmt::print("{}\n", list.dump());
    return {};
  }
  if (nodes->empty()) {
    fmt::print("no node without an id answers; rmac bus scan lists those that have one\n");
    return {};
  }
  std::vector<std::vector<std::string>> rows;
  for (const Identity& node : *nodes) rows.push_back(identity_row(node));
  fmt::print("{}", table({"vendor", "product", "revision", "serial"}, rows));
  return {};
}

/// A node id for the node that has none, or for the one of an identity.
struct Assignment {
  std::string interface;
  int node = 0;
  std::vector<std::uint32_t> identity;  ///< vendor, product, revision and serial number; empty: not given
};

Result<> assign(const Assignment& wanted) {
  const auto port = open_bus(wanted.interface);
  if (!port) return tl::unexpected(port.error());
  std::optional<Identity> identity;
  if (!wanted.identity.empty()) {
    identity = Identity{wanted.identity[0], wanted.identity[1], wanted.identity[2], wanted.identity[3]};
  }
  const auto given = canopen::lss_assign(**port, static_cast<std::uint8_t>(wanted.node), identity);
  if (!given) return fail(fmt::format("{}: {}", wanted.interface, given.error().message));
  fmt::print("node {} is {}{}\n", wanted.node, canopen::to_string(given->identity),
             given->stored ? "" : "; it does not store its id, and has none when it is switched off and on");
  return {};
}

struct BitRate {
  std::string interface;
  std::uint32_t bit_rate = 0;
  double delay_s = 10;
};

Result<> set_bit_rate(const BitRate& wanted) {
  const auto& [interface, bit_rate, delay_s] = wanted;
  const auto port = open_bus(interface);
  if (!port) return tl::unexpected(port.error());
  const auto nodes = everyone(**port);
  if (!nodes) return fail(fmt::format("{}: {}", interface, nodes.error().message));
  const auto delay = std::chrono::milliseconds(std::llround(delay_s * 1000));
  const auto done = canopen::lss_set_bit_rate(**port, *nodes, bit_rate, delay);
  if (!done) return fail(fmt::format("{}: {}", interface, done.error().message));
  fmt::print(
      "{} nodes go over to {} bit/s, and keep it; they speak again in {:g} s. Meanwhile, as administrator:\n"
      "  set BITRATE={} in can-{}.conf\n"
      "  systemctl restart rmac-can@{}\n"
      "and set bit_rate in device.json.\n",
      nodes->size(), bit_rate, 2 * delay_s, bit_rate, interface, interface);
  return {};
}

void add_scan(Command& lss) {
  const auto interface = std::make_shared<std::string>();
  Command scanned = lss.add("scan", "list the nodes that have no node id");
  scanned.option("INTERFACE", interface.get(), kInterfaceMeaning).required();
  scanned.does(without_appliance([interface](bool json) { return scan(*interface, json); }));
}

void add_assign(Command& lss) {
  const auto options = std::make_shared<Assignment>();
  Command assigned = lss.add("assign", "give a node an id: the one that has none, or the one of --identity");
  assigned.option("INTERFACE", &options->interface, kInterfaceMeaning).required();
  assigned.option("NODE", &options->node, "its id from now on").required().within(1, 126);
  assigned
      .option("--identity", &options->identity,
              "its vendor, product, revision and serial number; hexadecimal ones with 0x")
      .takes(4);
  assigned.does(without_appliance([options](bool) { return assign(*options); }));
}

void add_bit_rate(Command& lss) {
  const auto options = std::make_shared<BitRate>();
  Command rate = lss.add("bit-rate", "have all nodes take another bit rate, and say what is left to do");
  rate.option("INTERFACE", &options->interface, kInterfaceMeaning).required();
  rate.option("BITRATE", &options->bit_rate, "bit/s").required();
  rate.option("--delay", &options->delay_s, "s until they change, and again until they speak")
      .within(0.0, 65.0)
      .shows_default();
  rate.does(without_appliance([options](bool) { return set_bit_rate(*options); }));
}

}  // namespace

void add_bus_lss(Command& bus) {
  Command lss = bus.add("lss", "node ids and bit rates over the bus (CiA 305)");
  lss.needs_command();
  for (const Registration add : {add_scan, add_assign, add_bit_rate}) add(lss);
}

}  // namespace rmac::cli
