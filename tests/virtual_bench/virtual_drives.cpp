#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <vector>

#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "unit/fieldbus/virtual_drive.hpp"

// usage: virtual_drives INTERFACE NODE...: a drive for each node id, until a signal ends it. Says what changes: the
// power state of each, and its position then.
namespace {

using namespace rmac::fieldbus;
using rmac::fieldbus::test::VirtualDrive;

volatile std::sig_atomic_t ends = 0;

struct Watched {
  explicit Watched(std::uint8_t node) : drive(node) {}
  VirtualDrive drive;
  int state = -1;
};

void tell(Watched& watched, std::chrono::nanoseconds now) {
  constexpr const char* kNames[] = {"not-ready",         "switch-on-disabled", "ready-to-switch-on", "switched-on",
                                    "operation-enabled", "quick-stop",         "fault-reaction",     "fault"};
  const int state = watched.drive.state();
  if (state == watched.state) return;
  watched.state = state;
  std::printf("%.6f node %d %s at %.0f\n", std::chrono::duration<double>(now).count(), watched.drive.node(),
              kNames[state], watched.drive.position());
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "usage: virtual_drives INTERFACE NODE...\n");
    return 2;
  }
  auto port = SocketCanPort::open(words[1], {}, 1);
  if (!port) {
    std::fprintf(stderr, "virtual_drives: %s\n", port.error().message.c_str());
    return 1;
  }
  std::signal(SIGTERM, [](int) { ends = 1; });
  std::vector<std::unique_ptr<Watched>> drives;
  for (int i = 2; i < count; ++i) {
    drives.push_back(std::make_unique<Watched>(static_cast<std::uint8_t>(std::atoi(words[i]))));
    // The motor and screw of the example mill: rated torque on the inertia of motor and table, in encoder counts.
    constexpr double kCountsPerS2 = 3.0e8;
    drives.back()->drive.acceleration_counts_s2 = kCountsPerS2;
    drives.back()->drive.power_on((*port)->now());
  }
  while (ends == 0) {
    (*port)->wait(std::chrono::milliseconds(1));
    CanFrame frame;
    const auto send = [&] {
      for (auto& watched : drives) {
        for (const CanFrame& out : watched->drive.take_output()) (*port)->send(out);
      }
    };
    while ((*port)->receive(frame)) {
      for (auto& watched : drives) watched->drive.receive(frame, (*port)->now());
      send();
    }
    for (auto& watched : drives) {
      watched->drive.poll((*port)->now());
      tell(*watched, (*port)->now());
    }
    send();
  }
  return 0;
}
