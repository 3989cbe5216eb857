#include <gmock/gmock.h>

#include "gateway/buses/built_in_interfaces.hpp"
#include "unit/gateway/device_driver_manager/fixtures.hpp"

namespace {

using namespace rmac;
using namespace rmac::gateway;
using testing::HasSubstr;

/// What the registry answers when a mechanism wants `bus` as a CANopen bus.
std::string canopen_answer(const sdk::ModuleChoice& choice, const std::string& bus = "can0") {
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001);
  const ModuleLoader loader({});
  EXPECT_TRUE(registry.check_control_interface(choice, loader).has_value());
  const auto acquired = registry.acquire(bus, choice, loader);
  return acquired ? "acquired" : acquired.error().message;
}

TEST(CanopenBus, IsRefusedAboveItsShareBeforeAnythingIsSent) {
  EXPECT_EQ(
      canopen_answer({"CANopenInterface", {{"node", {1, 2, 3, 4}}}, {}}),
      "bus can0: 4 axes in a cycle of 1 ms need 951 bits, 95.1 % of the 1000 that 1000000 bit/s give; its share is "
      "80 %. Take a cycle of 1.19 ms or more, spread the axes over several buses, or map less");
}

TEST(CanopenBus, IsRefusedWithAWrongParameterThatIsNamed) {
  EXPECT_EQ(canopen_answer({"CANopenInterface", {{"node", {1}}, {"heartbeat_ms", {1}}}, {}}),
            "CANopenInterface, bus can0: heartbeat_ms is 1; allowed is a whole number from 2 to 10000");
}

TEST(CanopenBus, SaysWhichInterfaceIsNotThere) {
  // No interface has this name, whether the kernel knows CAN or not.
  EXPECT_THAT(canopen_answer({"CANopenInterface", {{"node", {1}}}, {}}, "no-such-can"),
              HasSubstr("bus no-such-can did not come up: CAN interface no-such-can: "));
}

// Red when a bus that is not in use keeps what it was made from: a description that was mended, or a data sheet, would
// count only once the daemon was started anew.
TEST(CanopenBus, ReadsWhatIsKnownOfDrivesAnewForEachStart) {
  const test::TemporaryFolder folder;
  BusRegistry registry;
  add_built_in_interfaces(registry, 0.001, folder.path());
  const auto refusal = [&] {
    const sdk::ModuleChoice choice{"CANopenInterface", {{"node", {1}}}, {{"drive", "maker-drive"}}};
    return registry.acquire("no-such-can", choice, ModuleLoader({})).error().message;
  };
  const std::string sound = R"({"Name": "a", "Manual": "b", "Tried": "never", "VendorId": 1, "ProductCode": 2)";
  EXPECT_THAT(refusal(), HasSubstr("drive is \"maker-drive\" for node 1, and there is no such description"));
  folder.write("maker-drive.json", sound + "}");
  EXPECT_THAT(refusal(), HasSubstr("bus no-such-can did not come up"));
  folder.write("maker-drive.json", sound + R"(, "SdoTimeout": 0})");
  EXPECT_THAT(refusal(), HasSubstr("maker-drive.json: /SdoTimeout is 0"));
  folder.write("maker-drive.json", sound + R"(, "SdoTimeout": 1})");
  EXPECT_THAT(refusal(), HasSubstr("bus no-such-can did not come up"));
}

}  // namespace
