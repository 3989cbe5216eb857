#include "rmac/fieldbus/canopen/lss.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "canopen/lss/fast_scan.hpp"
#include "canopen/lss/lss_master.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// Table 1 of the standard: bit timings by their index.
struct BitTiming {
  std::uint32_t bit_rate;
  std::uint8_t index;
};
constexpr std::array kBitTimings{BitTiming{1'000'000, 0}, BitTiming{800'000, 1}, BitTiming{500'000, 2},
                                 BitTiming{250'000, 3},   BitTiming{125'000, 4}, BitTiming{50'000, 6},
                                 BitTiming{20'000, 7},    BitTiming{10'000, 8}};

constexpr std::uint8_t kNoNode = 0xFF;

Expected<> require_free(CanPort& port, std::uint8_t node) {
  std::array<std::uint8_t, 4> bytes{};
  SdoClient sdo(node, {.timeout = std::chrono::milliseconds(200)});
  sdo.upload({0x1000, 0}, bytes, port.now());
  while (!sdo.finished()) {
    CanFrame frame;
    while (port.receive(frame)) {
      if (frame.id == kSdoAnswerId + node) sdo.receive(frame, port.now());
    }
    while (sdo.next_frame(port.now(), frame)) port.send(frame);
    port.wait(std::chrono::milliseconds(1));
  }
  if (sdo.state() == SdoClient::State::Failed) return {};
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("node {} is there already; give this one another id", node));
}

Expected<> await_boot(CanPort& port, std::uint8_t node, std::chrono::nanoseconds at_most) {
  const auto end = port.now() + at_most;
  while (port.now() < end) {
    CanFrame frame;
    while (port.receive(frame)) {
      if (frame.id == kHeartbeatId + node && frame.size == 1) return {};
    }
    port.wait(std::chrono::milliseconds(1));
  }
  return failure(MinorCode::CommTimeout,
                 fmt::format("the node took the id {} and did not come up with it within {:g} s; switch it off and on",
                             node, std::chrono::duration<double>(at_most).count()));
}

/// The only node without an id, which configures then.
Expected<Identity> claim_only(LssMaster& master) {
  FastScan scan(master);
  const auto found = scan.find(2);
  if (!found) return tl::unexpected(found.error());
  if (found->empty()) {
    return failure(MinorCode::CommTimeout, "there is no node without an id that answers a fast scan");
  }
  const bool one_identity = parts_of(found->front()) == parts_of(found->back());
  if (!one_identity) {
    return failure(MinorCode::InvalidParameterValue,
                   "there are several nodes without an id; say which one is meant by its vendor, product, revision and "
                   "serial number (rmac bus lss scan)");
  }
  if (found->size() > 1) return tl::unexpected(several_of(found->front(), found->size()));
  return scan.claim(found->front()).map([&] { return found->front(); });
}

}  // namespace

std::string to_string(const Identity& identity) {
  return fmt::format("vendor {:X}h, product {:X}h, revision {:X}h, serial {:X}h", identity.vendor_id,
                     identity.product_code, identity.revision_number, identity.serial_number);
}

Expected<std::vector<Identity>> lss_scan(CanPort& port, const LssOptions& options) {
  LssMaster master(port, options);
  constexpr std::size_t kMostNodes = 127;
  return master.begin().and_then([&] { return FastScan(master).find(kMostNodes); });
}

Expected<LssAssigned> lss_assign(CanPort& port, std::uint8_t node, const std::optional<Identity>& identity,
                                 const LssOptions& options) {
  LssMaster master(port, options);
  auto ready = master.begin().and_then([&] { return require_free(port, node); });
  if (!ready) return tl::unexpected(ready.error());
  LssAssigned assigned;
  if (identity) {
    if (auto selected = master.select(*identity); !selected) return tl::unexpected(selected.error());
    assigned.identity = *identity;
  } else {
    auto found = claim_only(master);
    if (!found) return tl::unexpected(found.error());
    assigned.identity = *found;
  }
  if (auto alone = master.check_selected(assigned.identity); !alone) return tl::unexpected(alone.error());
  const auto before = master.node_of_selected();
  if (auto done = master.configure(LssCommand::ConfigureNode, {node}, fmt::format("it was given the id {}", node));
      !done) {
    return tl::unexpected(done.error());
  }
  assigned.stored = master.configure(LssCommand::StoreConfiguration, {}, "it was told to store its id").has_value();
  master.switch_all(false);
  // One that had an id goes on with it until it is reset.
  if (before && *before != kNoNode) port.send(nmt_frame(NmtCommand::ResetCommunication, *before));
  if (auto up = await_boot(port, node, options.boot_timeout); !up) return tl::unexpected(up.error());
  return assigned;
}

Expected<> lss_set_bit_rate(CanPort& port, const std::vector<Identity>& nodes, std::uint32_t bit_rate,
                            std::chrono::milliseconds switch_delay, const LssOptions& options) {
  const auto timing = std::find_if(kBitTimings.begin(), kBitTimings.end(),
                                   [&](const BitTiming& known) { return known.bit_rate == bit_rate; });
  constexpr std::chrono::milliseconds kMostDelay{0xFFFF};
  if (timing == kBitTimings.end() || switch_delay.count() < 0 || switch_delay > kMostDelay) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("{} bit/s after {} ms: bit rates are 10000, 20000, 50000, 125000, 250000, 500000, 800000 "
                    "and 1000000, and a delay is 65535 ms at most",
                    bit_rate, switch_delay.count()));
  }
  if (nodes.empty()) return failure(MinorCode::InvalidParameterValue, "there is no node that could change");
  LssMaster master(port, options);
  if (auto begun = master.begin(); !begun) return begun;
  // All are asked whether they can before any of them keeps it.
  for (const bool stores : {false, true}) {
    for (const Identity& identity : nodes) {
      auto told = master.select(identity).and_then([&] {
        return stores ? master.configure(LssCommand::StoreConfiguration, {}, "it was told to store its bit rate")
                      : master.configure(LssCommand::ConfigureBitTiming, {0, timing->index},
                                         fmt::format("it was given {} bit/s", bit_rate));
      });
      if (told) continue;
      return failure(told.error().code,
                     fmt::format("{}: {}; no node changes now{}", to_string(identity), told.error().message,
                                 stores ? ", and some will when they are switched off and on" : ""));
    }
  }
  master.switch_all(true);
  master.activate_bit_timing(switch_delay);
  return {};
}

}  // namespace rmac::fieldbus::canopen
