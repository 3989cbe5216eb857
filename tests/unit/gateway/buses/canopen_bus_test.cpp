#include <gmock/gmock.h>

#include "gateway/buses/built_in_interfaces.hpp"

namespace {

using namespace rmac;
using namespace rmac::gateway;
using testing::HasSubstr;

/// What the registry answers when a mechanism wants `bus` as a CANopen bus.
std::string answer(const sdk::ModuleChoice& choice, const std::string& bus = "can0") {
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001);
  const ModuleLoader loader({});
  EXPECT_TRUE(registry.check_control_interface(choice, loader).has_value());
  const auto acquired = registry.acquire(bus, choice, loader);
  return acquired ? "acquired" : acquired.error().message;
}

TEST(CanopenBus, IsRefusedAboveItsShareBeforeAnythingIsSent) {
  EXPECT_EQ(
      answer({"CANopenInterface", {{"node", {1, 2, 3, 4}}}, {}}),
      "bus can0: 4 axes in a cycle of 1 ms need 951 bits, 95.1 % of the 1000 that 1000000 bit/s give; its share is "
      "80 %. Take a cycle of 1.19 ms or more, spread the axes over several buses, or map less");
}

TEST(CanopenBus, IsRefusedWithAWrongParameterThatIsNamed) {
  EXPECT_EQ(answer({"CANopenInterface", {{"node", {1}}, {"heartbeat_ms", {1}}}, {}}),
            "CANopenInterface, bus can0: heartbeat_ms is 1; allowed is a whole number from 2 to 10000");
}

TEST(CanopenBus, SaysWhichInterfaceIsNotThere) {
  // No interface has this name, whether the kernel knows CAN or not.
  EXPECT_THAT(answer({"CANopenInterface", {{"node", {1}}}, {}}, "no-such-can"),
              HasSubstr("bus no-such-can did not come up: CAN interface no-such-can: "));
}

}  // namespace
