#include "rmac/fieldbus/canopen/bus_scan.hpp"

#include <gmock/gmock.h>

#include <map>
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
  EXPECT_EQ(device_type_text(0x00080192), "drive (CiA 402)");
  EXPECT_EQ(device_type_text(0xFF000192), "drive (CiA 402)") << "the highest byte is the maker's";
  EXPECT_EQ(device_type_text(0x00030191), "I/O, digital in, digital out (CiA 401)");
  EXPECT_EQ(device_type_text(0), "no standard profile");
  EXPECT_EQ(device_type_text(404), "measuring device (CiA 404)");
  EXPECT_EQ(device_type_text(406), "encoder (CiA 406)");
  EXPECT_EQ(device_type_text(408), "hydraulic drive (CiA 408)");
  EXPECT_EQ(device_type_text(410), "inclinometer (CiA 410)");
  EXPECT_EQ(device_type_text(0x123), "profile CiA 291");
}

TEST(DeviceType, OfAnIoDeviceSaysWhatItHas) {
  for (std::uint32_t bits = 0; bits < 16; ++bits) {
    std::string has = "I/O";
    if ((bits & 1) != 0) has += ", digital in";
    if ((bits & 2) != 0) has += ", digital out";
    if ((bits & 4) != 0) has += ", analogue in";
    if ((bits & 8) != 0) has += ", analogue out";
    EXPECT_EQ(device_type_text(bits << 16 | 401), has + " (CiA 401)");
  }
}

/// A bus that is listened to, with these frames on it.
Expected<> idle_with(CanWire& wire, const std::vector<CanFrame>& frames, std::vector<CanFrame>* seen = nullptr) {
  const auto port = wire.open();
  for (const CanFrame& frame : frames) wire.inject(frame);
  return check_idle(*port, std::chrono::milliseconds(500), [&](const CanFrame& frame) {
    if (seen != nullptr) seen->push_back(frame);
  });
}

TEST(IdleBus, IsListenedToForItsTimeAndShowsAllThatCameMeanwhile) {
  CanWire wire;
  const auto begin = wire.now();
  const std::vector<CanFrame> frames{{.id = 0x181, .size = 8},
                                     {.id = 0x705, .size = 1, .data = {127}},
                                     {.id = 0x705, .size = 1, .data = {4}},
                                     {.id = 0x705, .size = 2, .data = {5}},
                                     {.id = 0x700, .size = 1, .data = {5}},
                                     {.id = 0x7F, .size = 0},
                                     {.id = 0x81, .size = 8},
                                     {.id = 0x585, .size = 1, .data = {5}}};
  std::vector<CanFrame> seen;
  EXPECT_TRUE(idle_with(wire, frames, &seen));
  EXPECT_EQ(wire.now() - begin, std::chrono::milliseconds(500));
  EXPECT_EQ(seen, frames);
}

TEST(IdleBus, IsNoneWhereThereIsSyncOrANodeThatIsOperational) {
  CanWire wire;
  const auto sync = idle_with(wire, {{.id = 0x80, .size = 0}});
  ASSERT_FALSE(sync);
  EXPECT_THAT(sync.error().message, HasSubstr("there is SYNC"));
  for (const int node : {1, 127}) {
    const auto id = static_cast<std::uint16_t>(0x700 + node);
    const auto works = idle_with(wire, {{.id = id, .size = 1, .data = {5}}});
    ASSERT_FALSE(works);
    EXPECT_THAT(works.error().message, HasSubstr("node " + std::to_string(node) + " is operational"));
  }
  const auto port = wire.open();
  wire.inject({.id = 0x80});
  EXPECT_FALSE(check_idle(*port, std::chrono::milliseconds(500))) << "also where nobody wants to see the frames";
}

// Red when all questions come at once, which no transmit queue holds.
TEST_F(BusScan, BeginsWithOneNodeMoreARound) {
  std::map<int, std::chrono::nanoseconds> first;
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id > 0x600 && frame.id < 0x680) first.try_emplace(frame.id - 0x600, wire_.now());
  };
  scan();
  ASSERT_EQ(first.size(), 127U);
  for (int node = 2; node <= 127; ++node)
    EXPECT_EQ(first[node] - first[node - 1], std::chrono::milliseconds(2)) << node;
}

// Red when it does not ask twice who it is: two devices of one id may take turns to answer.
TEST_F(BusScan, AsksWhatANodeIsAndTwiceWhoItIs) {
  wire_.add(3);
  std::vector<ObjectAddress> asked;
  wire_.listen = [&](const CanFrame& frame) {
    if (frame.id == 0x603) asked.push_back({word_at(&frame.data[1]), frame.data[3]});
  };
  scan();
  wire_.listen = nullptr;
  EXPECT_EQ(asked, (std::vector<ObjectAddress>{{0x1000, 0},
                                               {0x1018, 1},
                                               {0x1018, 2},
                                               {0x1018, 3},
                                               {0x1018, 4},
                                               {0x1008, 0},
                                               {0x1018, 1},
                                               {0x1018, 2},
                                               {0x1018, 3},
                                               {0x1018, 4}}));
}

TEST_F(BusScan, WaitsForAnAnswerAsLongAsItIsTold) {
  wire_.add(3).sdo_time = std::chrono::milliseconds(150);
  EXPECT_EQ(scan().size(), 1U);
  const auto port = wire_.open();
  const auto hasty = scan_bus(*port, {.timeout = std::chrono::milliseconds(140)});
  ASSERT_TRUE(hasty);
  EXPECT_TRUE(hasty->empty());
}

TEST_F(BusScan, KeepsWhatANodeToldBeforeItFellSilent) {
  wire_.add(3).silent = {{0x1018, 3}};
  const auto found = scan();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].answers);
  EXPECT_EQ(found[0].identity.product_code, 0x203U);
  EXPECT_EQ(found[0].identity.revision_number, 0U);
}

TEST_F(BusScan, GoesOnBehindWhatANodeRefuses) {
  VirtualDrive& drive = wire_.add(3);
  drive.refuse_reading({0x1000, 0}, 0x06010000);
  drive.refuse_reading({0x1018, 2}, 0x06010000);
  const auto found = scan();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].answers);
  EXPECT_EQ(found[0].device_type, 0U);
  EXPECT_EQ(found[0].identity.product_code, 0U);
  EXPECT_EQ(found[0].identity.serial_number, 0x403U);
}

TEST_F(BusScan, TakesNumbersAsLongAsTheNodeTellsThem) {
  VirtualDrive& drive = wire_.add(3);
  drive.set_bytes({0x1018, 1}, {0xFF, 0xFF, 0xFF, 0xFF});
  drive.set_bytes({0x1018, 2}, {0x12});
  drive.set_bytes({0x1018, 3}, {0x34, 0x12});
  const auto found = scan();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].identity.vendor_id, 0xFFFFFFFFU);
  EXPECT_EQ(found[0].identity.product_code, 0x12U) << "and nothing of the number before";
  EXPECT_EQ(found[0].identity.revision_number, 0x1234U);
}

TEST_F(BusScan, PrintsFromTheBlankToTheTilde) {
  Bytes all;
  for (int c = 0; c < 128; ++c) all.push_back(static_cast<std::uint8_t>(c == 127 ? 0xE4 : c + 1));
  VirtualDrive& drive = wire_.add(3);
  name(drive, all);
  drive.power_on(wire_.now());
  std::string printable;
  for (char c = ' '; c <= '~'; ++c) printable += c;
  ASSERT_EQ(scan().size(), 1U);
  EXPECT_EQ(scan()[0].name, printable);
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
  sheet.product_number = 0;
  EXPECT_TRUE(describes(sheet, node)) << "it is for all products of a make";
  sheet.product_number = 8;
  EXPECT_FALSE(describes(sheet, node));
  sheet.product_number = 7;
  node.answers = false;
  EXPECT_FALSE(describes(sheet, node)) << "nobody knows who that is";
}

}  // namespace
