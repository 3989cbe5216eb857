#include <fmt/format.h>

#include "gateway/rmac/commands/bus/registrations.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/stored_parameters.hpp"

namespace rmac::cli {
namespace {

using fieldbus::canopen::StoreCommand;

struct StoreOptions {
  std::string interface;
  int node = 0;
};

/// Has a node keep its parameters as they are now (1010h), or take the maker's from its next reset on (1011h).
Result<> store_node(const StoreOptions& options, StoreCommand what) {
  constexpr std::size_t kBurst = 4;
  auto port = fieldbus::SocketCanPort::open(options.interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  const auto done = fieldbus::canopen::store_parameters(**port, static_cast<std::uint8_t>(options.node), what);
  if (!done) return fail(fmt::format("{}: {}", options.interface, done.error().message));
  fmt::print("node {} {}\n", options.node,
             what == StoreCommand::LoadDefaults
                 ? "takes its maker's parameters from its next reset on: switch it off and on"
                 : "keeps its parameters as they are now");
  return {};
}

void add_storing(Command& bus, const char* name, const char* meaning, StoreCommand what) {
  const auto options = std::make_shared<StoreOptions>();
  Command store = bus.add(name, meaning);
  store.option("INTERFACE", &options->interface, kInterfaceMeaning).required();
  store.option("NODE", &options->node, "its node id").required().within(1, 127);
  store.does(without_appliance([options, what](bool) { return store_node(*options, what); }));
}

}  // namespace

void add_bus_store(Command& bus) {
  add_storing(bus, "store", "have a node keep its parameters as they are now, without power too (1010h)",
              StoreCommand::Save);
  add_storing(bus, "restore", "have a node take its maker's parameters from its next reset on (1011h)",
              StoreCommand::LoadDefaults);
}

}  // namespace rmac::cli
