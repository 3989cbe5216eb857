#include "rmac/fieldbus/canopen/stored_parameters.hpp"

#include <array>

#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/object_access.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::array<std::uint8_t, 4> kLoad{'l', 'o', 'a', 'd'};
constexpr std::chrono::seconds kTimeToWrite{10};  // drives erase and write whole pages of flash

}  // namespace

Expected<> store_parameters(CanPort& port, std::uint8_t node, StoreCommand command) {
  if (auto idle = check_idle(port, ScanOptions().listen); !idle) return idle;
  const bool saves = command == StoreCommand::Save;
  const ObjectAddress object{static_cast<std::uint16_t>(saves ? 0x1010 : 0x1011), 1};
  return write_object(port, node, object, saves ? kSaveSignature : kLoad, kTimeToWrite);
}

}  // namespace rmac::fieldbus::canopen
