#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/table.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/lss.hpp"

namespace rmac::cli {
namespace {

namespace canopen = fieldbus::canopen;
using canopen::Identity;

Result<std::unique_ptr<fieldbus::SocketCanPort>> open(const std::string& interface) {
  constexpr std::size_t kBurst = 8;
  auto port = fieldbus::SocketCanPort::open(interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  return std::move(*port);
}

std::vector<std::string> to_row(const Identity& identity) {
  const auto hexadecimal = [](std::uint32_t number) { return fmt::format("{:X}h", number); };
  return {hexadecimal(identity.vendor_id), hexadecimal(identity.product_code), hexadecimal(identity.revision_number),
          hexadecimal(identity.serial_number)};
}

/// Everyone on the bus: those with an id by SDO, the others by fast scan.
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

}  // namespace

Result<> lss_scan(const std::string& interface, bool json) {
  const auto port = open(interface);
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
  for (const Identity& node : *nodes) rows.push_back(to_row(node));
  fmt::print("{}", table({"vendor", "product", "revision", "serial"}, rows));
  return {};
}

Result<> lss_assign(const LssAssignment& wanted) {
  const auto port = open(wanted.interface);
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

Result<> lss_set_bit_rate(const std::string& interface, std::uint32_t bit_rate, double delay_s) {
  const auto port = open(interface);
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

}  // namespace rmac::cli
