#include "rmac/fieldbus/canopen/bus_scan.hpp"

#include <gmock/gmock.h>

#include <set>

#include "rmac/fieldbus/canopen/stored_parameters.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using namespace rmac::fieldbus::test;
using testing::HasSubstr;

class BusScan : public CanopenBench {
 protected:
  std::vector<ScannedNode> scan() {
    const auto port = wire_.open();
    auto found = scan_bus(*port);
    EXPECT_TRUE(found.has_value()) << (found ? "" : found.error().message);
    return found.value_or(std::vector<ScannedNode>());
  }
};

void name(VirtualDrive& drive, const Bytes& text) {
  drive.power_off();
  drive.set_bytes({0x1008, 0}, text);
}

TEST_F(BusScan, FindsEveryNodeAndWhoItIs) {
  for (const int node : {1, 64, 127}) wire_.add(static_cast<std::uint8_t>(node));
  const auto found = scan();
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[1].node, 64);
  EXPECT_TRUE(found[1].answers);
  EXPECT_EQ(found[1].device_type, 0x00020192U);
  EXPECT_EQ(found[1].identity.vendor_id, 0x100U + 64);
  EXPECT_EQ(found[1].identity.product_code, 0x200U + 64);
  EXPECT_EQ(found[1].identity.revision_number, 0x300U + 64);
  EXPECT_EQ(found[1].identity.serial_number, 0x400U + 64);
  EXPECT_EQ(found[1].name, "") << "it has no 1008h";
  EXPECT_FALSE(found[1].state.has_value()) << "it makes no heartbeat";
}

TEST_F(BusScan, ReadsNamesOfAnyLengthAndPrintsNothingElse) {
  const std::string text = "servo\x07 of seventeen\n letters and some more";
  VirtualDrive& drive = wire_.add(3);
  name(drive, Bytes(text.begin(), text.end()));
  drive.power_on(wire_.now());
  const auto found = scan();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].name, "servo of seventeen letters and some more");
}

TEST_F(BusScan, AsksAndWritesNothing) {
  bool wrote = false;
  std::set<std::uint16_t> sent;
  wire_.add(3).on_write = [&](Object, const Bytes&) { wrote = true; };
  wire_.listen = [&](const CanFrame& frame) { sent.insert(frame.id); };
  scan();
  wire_.listen = nullptr;
  EXPECT_FALSE(wrote);
  for (const std::uint16_t id : sent) EXPECT_TRUE((id > 0x600 && id < 0x680) || id == 0x583) << std::hex << id;
}

TEST_F(BusScan, ListsANodeThatOnlyBeats) {
  VirtualDrive& drive = wire_.add(9);
  drive.power_off();
  drive.set(0x1017, 0, 100, 2);
  drive.power_on(wire_.now());
  drive.answers_sdo = false;
  const auto found = scan();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_FALSE(found[0].answers);
  EXPECT_EQ(found[0].state, NmtState::PreOperational);
}

TEST_F(BusScan, RefusesABusOnWhichAMachineRuns) {
  VirtualDrive& drive = wire_.add(9);
  drive.power_off();
  drive.set(0x1017, 0, 100, 2);
  drive.power_on(wire_.now());
  drive.receive({.id = 0, .size = 2, .data = {1, 9}}, wire_.now());
  int sent = 0;
  wire_.listen = [&](const CanFrame& frame) { sent += frame.id > 0x600 && frame.id < 0x680 ? 1 : 0; };
  const auto port = wire_.open();
  const auto refused = scan_bus(*port);
  ASSERT_FALSE(refused.has_value());
  EXPECT_EQ(refused.error().message,
            "a machine runs on this bus: node 9 is operational. Unload it first (rmac unload)");
  const auto other = wire_.open();
  wire_.inject({.id = 0x80});
  const auto again = scan_bus(*other);
  ASSERT_FALSE(again.has_value());
  EXPECT_THAT(again.error().message, HasSubstr("a machine runs on this bus: there is SYNC"));
  EXPECT_EQ(sent, 0) << "it listens before it asks";
  wire_.listen = nullptr;
}

TEST_F(BusScan, SaysWhenNothingGetsOntoTheBus) {
  wire_.add(1);
  wire_.full = true;
  const auto port = wire_.open();
  const auto found = scan_bus(*port);
  ASSERT_FALSE(found.has_value());
  EXPECT_THAT(found.error().message, HasSubstr("the interface gets no frame onto the bus"));
}

class StoredParameters : public BusScan {
 protected:
  std::string answer(std::uint8_t node, StoreCommand command) {
    const auto port = wire_.open();
    const auto done = store_parameters(*port, node, command);
    return done ? "done" : done.error().message;
  }
};

TEST_F(StoredParameters, AreSavedAndForgottenByTheirSignatures) {
  VirtualDrive& drive = wire_.add(3);
  drive.set(0x1010, 1, 1, 4);
  drive.set(0x1011, 1, 1, 4);
  std::vector<std::pair<Object, Bytes>> written;
  drive.on_write = [&](Object object, const Bytes& bytes) { written.emplace_back(object, bytes); };
  EXPECT_EQ(answer(3, StoreCommand::Save), "done");
  EXPECT_EQ(answer(3, StoreCommand::LoadDefaults), "done");
  EXPECT_THAT(written, testing::ElementsAre(std::pair(Object{0x1010, 1}, Bytes{0x73, 0x61, 0x76, 0x65}),
                                            std::pair(Object{0x1011, 1}, Bytes{0x6C, 0x6F, 0x61, 0x64})));
}

TEST_F(StoredParameters, AreLeftAloneWhereAMachineRunsOrANodeRefuses) {
  VirtualDrive& drive = wire_.add(3);
  EXPECT_EQ(answer(3, StoreCommand::Save),
            "node 3 refused 1010h:01: object does not exist in the object dictionary (06020000h)");
  EXPECT_EQ(answer(4, StoreCommand::Save), "node 4 does not answer; rmac bus scan lists those that do");
  bool wrote = false;
  drive.on_write = [&](Object, const Bytes&) { wrote = true; };
  const auto port = wire_.open();
  wire_.inject({.id = 0x80});
  EXPECT_FALSE(store_parameters(*port, 3, StoreCommand::Save).has_value());
  EXPECT_FALSE(wrote);
}

TEST(DeviceType, IsNamedByItsProfile) {
  EXPECT_EQ(device_type_text(0x00020192), "servo drive (CiA 402)");
  EXPECT_EQ(device_type_text(0x00010192), "frequency converter (CiA 402)");
  EXPECT_EQ(device_type_text(0x00040192), "stepper drive (CiA 402)");
  EXPECT_EQ(device_type_text(0x00030191), "I/O, digital in, digital out (CiA 401)");
  EXPECT_EQ(device_type_text(0), "no standard profile");
  EXPECT_EQ(device_type_text(0x123), "profile CiA 291");
}

TEST(DeviceDescription, FitsTheNodesThatItsNumbersName) {
  ScannedNode node;
  node.answers = true;
  node.identity = {.vendor_id = 0x1A1, .product_code = 7};
  eds::DeviceDescription sheet;
  EXPECT_FALSE(describes(sheet, node)) << "a file that tells no number fits nothing";
  sheet.product_number = 7;
  EXPECT_TRUE(describes(sheet, node));
  sheet.vendor_number = 0x1A2;
  EXPECT_FALSE(describes(sheet, node));
  sheet.vendor_number = 0x1A1;
  EXPECT_TRUE(describes(sheet, node));
}

}  // namespace
