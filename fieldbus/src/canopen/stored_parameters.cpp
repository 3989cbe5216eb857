#include "rmac/fieldbus/canopen/stored_parameters.hpp"

#include <fmt/format.h>

#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::array<std::uint8_t, 4> kSave{'s', 'a', 'v', 'e'};
constexpr std::array<std::uint8_t, 4> kLoad{'l', 'o', 'a', 'd'};
constexpr std::chrono::seconds kTimeToWrite{10};  // drives erase and write whole pages of flash

}  // namespace

Expected<> store_parameters(CanPort& port, std::uint8_t node, StoreCommand command) {
  if (auto idle = check_idle(port, ScanOptions().listen); !idle) return idle;
  const bool saves = command == StoreCommand::Save;
  const ObjectAddress object{static_cast<std::uint16_t>(saves ? 0x1010 : 0x1011), 1};
  SdoClient sdo(node, {.timeout = kTimeToWrite});
  sdo.download(object, saves ? kSave : kLoad, port.now());
  while (!sdo.finished()) {
    CanFrame frame;
    while (port.receive(frame)) {
      if (frame.id == kSdoAnswerId + node) sdo.receive(frame, port.now());
    }
    while (sdo.next_frame(port.now(), frame)) port.send(frame);
    port.wait(std::chrono::milliseconds(2));
  }
  if (sdo.state() == SdoClient::State::Done) return {};
  if (sdo.state() == SdoClient::State::Refused) {
    return failure(MinorCode::Other, fmt::format("node {} refused {}: {} ({:08X}h)", node, to_string(object),
                                                 sdo_abort_text(sdo.abort_code()), sdo.abort_code()));
  }
  return failure(MinorCode::CommTimeout,
                 fmt::format("node {} does not answer; rmac bus scan lists those that do", node));
}

}  // namespace rmac::fieldbus::canopen
