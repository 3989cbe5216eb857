#include "rmac/fieldbus/canopen/lss.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint16_t kRequestId = 0x7E5, kAnswerId = 0x7E4;

// Command specifiers (CiA 305, 3.8)
enum Command : std::uint8_t {
  SwitchAll = 0x04,
  ConfigureNode = 0x11,
  ConfigureBitTiming = 0x13,
  ActivateBitTiming = 0x15,
  StoreConfiguration = 0x17,
  SelectVendor = 0x40,
  SelectProduct = 0x41,
  SelectRevision = 0x42,
  SelectSerial = 0x43,
  Selected = 0x44,
  Identified = 0x4F,
  FastScan = 0x51,
  InquireNode = 0x5E
};

/// Table 1 of the standard: bit timings by their index.
struct BitTiming {
  std::uint32_t bit_rate;
  std::uint8_t index;
};
constexpr std::array kBitTimings{BitTiming{1'000'000, 0}, BitTiming{800'000, 1}, BitTiming{500'000, 2},
                                 BitTiming{250'000, 3},   BitTiming{125'000, 4}, BitTiming{50'000, 6},
                                 BitTiming{20'000, 7},    BitTiming{10'000, 8}};

constexpr std::uint8_t kNoNode = 0xFF;

class Master {
 public:
  Master(CanPort& port, const LssOptions& options) : port_(port), options_(options) {}
  Master(const Master&) = delete;
  Master& operator=(const Master&) = delete;
  ~Master() { switch_all(false); }

  Expected<> begin() {
    auto idle = check_idle(port_, options_.listen);
    if (idle) switch_all(false);
    return idle;
  }

  void switch_all(bool configure) { send({SwitchAll, static_cast<std::uint8_t>(configure ? 1 : 0)}); }

  /// The answer to a request, if one comes in time.
  std::optional<CanFrame> ask(std::initializer_list<std::uint8_t> request, Command answer) {
    send_alone(request);
    const auto end = port_.now() + options_.timeout;
    while (port_.now() < end) {
      if (const auto came = received(answer)) return came;
      port_.wait(std::min<std::chrono::nanoseconds>(end - port_.now(), std::chrono::milliseconds(1)));
    }
    return {};
  }

  /// One node without an id, which configures from then on; none where there is no other.
  std::optional<Identity> fast_scan() {
    constexpr std::uint8_t kBegin = 0x80, kLastPart = 3;
    if (!scan_step(0, kBegin, 0, 0)) return {};
    std::array<std::uint32_t, 4> parts{};
    for (std::uint8_t part = 0; part <= kLastPart; ++part) {
      std::uint32_t& number = parts.at(part);
      for (std::uint8_t bit = 32; bit-- > 0;) {
        if (!scan_step(number, bit, part, part)) number |= 1U << bit;
      }
      // It goes on to the next part by this, and after the last one it configures.
      const auto next = static_cast<std::uint8_t>(part == kLastPart ? 0 : part + 1);
      if (!scan_step(number, 0, part, next)) return {};
    }
    return Identity{parts[0], parts[1], parts[2], parts[3]};
  }

  Expected<> select(const Identity& identity) {
    switch_all(false);
    tell(SelectVendor, identity.vendor_id);
    tell(SelectProduct, identity.product_code);
    tell(SelectRevision, identity.revision_number);
    const std::uint32_t serial = identity.serial_number;
    if (ask({SelectSerial, byte(serial, 0), byte(serial, 1), byte(serial, 2), byte(serial, 3)}, Selected)) return {};
    return failure(MinorCode::CommTimeout,
                   fmt::format("no node answers to {}: it is not there, or knows no LSS", to_string(identity)));
  }

  /// Its answer says 0, or why not.
  Expected<> configure(std::initializer_list<std::uint8_t> request, const std::string& what) {
    const auto done = ask(request, static_cast<Command>(*request.begin()));
    if (!done) return failure(MinorCode::CommTimeout, fmt::format("the node did not answer when {}", what));
    if (done->data[1] == 0) return {};
    constexpr std::uint8_t kNotKept = 2, kOfItsOwn = 0xFF;
    const std::string why = done->data[1] == kOfItsOwn  ? fmt::format("error {} of its maker", done->data[2])
                            : done->data[1] == kNotKept ? "its memory cannot be written"
                                                        : "out of its range, or not supported";
    return failure(MinorCode::Other, fmt::format("the node refused when {}: {}", what, why));
  }

  std::optional<std::uint8_t> node_of_selected() {
    const auto told = ask({InquireNode}, InquireNode);
    return told ? std::optional(told->data[1]) : std::nullopt;
  }

  void activate(std::chrono::milliseconds delay) {
    const auto ms = static_cast<std::uint32_t>(delay.count());
    send({ActivateBitTiming, byte(ms, 0), byte(ms, 1)});
  }

  Expected<> require_free(std::uint8_t node) {
    std::array<std::uint8_t, 4> bytes{};
    SdoClient sdo(node, {.timeout = std::chrono::milliseconds(200)});
    sdo.upload({0x1000, 0}, bytes, port_.now());
    while (!sdo.finished()) {
      CanFrame frame;
      while (port_.receive(frame)) {
        if (frame.id == kSdoAnswerId + node) sdo.receive(frame, port_.now());
      }
      while (sdo.next_frame(port_.now(), frame)) port_.send(frame);
      port_.wait(std::chrono::milliseconds(1));
    }
    if (sdo.state() == SdoClient::State::Failed) return {};
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("node {} is there already; give this one another id", node));
  }

  Expected<> await_boot(std::uint8_t node) {
    const auto end = port_.now() + options_.boot_timeout;
    while (port_.now() < end) {
      CanFrame frame;
      while (port_.receive(frame)) {
        if (frame.id == kHeartbeatId + node && frame.size == 1) return {};
      }
      port_.wait(std::chrono::milliseconds(1));
    }
    return failure(
        MinorCode::CommTimeout,
        fmt::format("the node took the id {} and did not come up with it within {:g} s; switch it off and on", node,
                    std::chrono::duration<double>(options_.boot_timeout).count()));
  }

  void reset(std::uint8_t node) { port_.send(nmt_frame(NmtCommand::ResetCommunication, node)); }

 private:
  /// Sends what only an answer that comes from now on can belong to.
  void send_alone(std::initializer_list<std::uint8_t> request) {
    CanFrame frame;
    while (port_.receive(frame)) {
    }
    send(request);
  }
  std::optional<CanFrame> received(Command answer) {
    CanFrame frame;
    while (port_.receive(frame)) {
      if (frame.id == kAnswerId && frame.size == 8 && frame.data[0] == answer) return frame;
    }
    return {};
  }
  static std::uint8_t byte(std::uint32_t number, unsigned at) { return static_cast<std::uint8_t>(number >> (8 * at)); }

  void send(std::initializer_list<std::uint8_t> bytes) {
    CanFrame frame{.id = kRequestId, .size = 8};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    port_.send(frame);
  }
  void tell(Command command, std::uint32_t number) {
    send({command, byte(number, 0), byte(number, 1), byte(number, 2), byte(number, 3)});
  }
  /// Whether any node fits. Many may answer, each when it is ready: all of the time has to pass, or a late one's answer
  /// would be taken for that to the next step.
  bool scan_step(std::uint32_t number, std::uint8_t bit, std::uint8_t part, std::uint8_t next) {
    send_alone({FastScan, byte(number, 0), byte(number, 1), byte(number, 2), byte(number, 3), bit, part, next});
    bool fits = false;
    for (const auto end = port_.now() + options_.timeout; port_.now() < end;) {
      port_.wait(std::min<std::chrono::nanoseconds>(end - port_.now(), std::chrono::milliseconds(1)));
      while (received(Identified)) fits = true;
    }
    return fits;
  }

  CanPort& port_;
  LssOptions options_;
};

/// The only node without an id, which configures then.
Expected<Identity> find_only(Master& master) {
  const auto found = master.fast_scan();
  if (!found) return failure(MinorCode::CommTimeout, "there is no node without an id that answers a fast scan");
  if (master.fast_scan()) {
    return failure(MinorCode::InvalidParameterValue,
                   "there are several nodes without an id; say which one is meant by its vendor, product, revision and "
                   "serial number (rmac bus lss scan)");
  }
  return *found;
}

}  // namespace

std::string to_string(const Identity& identity) {
  return fmt::format("vendor {:X}h, product {:X}h, revision {:X}h, serial {:X}h", identity.vendor_id,
                     identity.product_code, identity.revision_number, identity.serial_number);
}

Expected<std::vector<Identity>> lss_scan(CanPort& port, const LssOptions& options) {
  Master master(port, options);
  if (auto begun = master.begin(); !begun) return tl::unexpected(begun.error());
  std::vector<Identity> found;
  constexpr std::size_t kMostNodes = 127;
  while (found.size() < kMostNodes) {
    const auto next = master.fast_scan();
    if (!next) break;
    found.push_back(*next);
  }
  return found;
}

Expected<LssAssigned> lss_assign(CanPort& port, std::uint8_t node, const std::optional<Identity>& identity,
                                 const LssOptions& options) {
  Master master(port, options);
  auto ready = master.begin().and_then([&] { return master.require_free(node); });
  if (!ready) return tl::unexpected(ready.error());
  LssAssigned assigned;
  if (identity) {
    if (auto selected = master.select(*identity); !selected) return tl::unexpected(selected.error());
    assigned.identity = *identity;
  } else {
    auto found = find_only(master);
    if (!found) return tl::unexpected(found.error());
    assigned.identity = *found;
  }
  const auto before = master.node_of_selected();
  if (auto done = master.configure({ConfigureNode, node}, fmt::format("it was given the id {}", node)); !done) {
    return tl::unexpected(done.error());
  }
  assigned.stored = master.configure({StoreConfiguration}, "it was told to store its id").has_value();
  master.switch_all(false);
  // One that had an id goes on with it until it is reset.
  if (before && *before != kNoNode) master.reset(*before);
  if (auto up = master.await_boot(node); !up) return tl::unexpected(up.error());
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
  Master master(port, options);
  if (auto begun = master.begin(); !begun) return begun;
  // All are asked whether they can before any of them keeps it.
  for (const bool stores : {false, true}) {
    for (const Identity& identity : nodes) {
      auto told = master.select(identity).and_then([&] {
        return stores ? master.configure({StoreConfiguration}, "it was told to store its bit rate")
                      : master.configure({ConfigureBitTiming, 0, timing->index},
                                         fmt::format("it was given {} bit/s", bit_rate));
      });
      if (told) continue;
      return failure(told.error().code,
                     fmt::format("{}: {}; no node changes now{}", to_string(identity), told.error().message,
                                 stores ? ", and some will when they are switched off and on" : ""));
    }
  }
  master.switch_all(true);
  master.activate(switch_delay);
  return {};
}

}  // namespace rmac::fieldbus::canopen
