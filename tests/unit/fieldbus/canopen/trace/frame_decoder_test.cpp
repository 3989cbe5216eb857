#include "rmac/fieldbus/canopen/frame_decoder.hpp"

#include <gmock/gmock.h>

#include <random>

#include "canopen/pdo.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"
#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using namespace rmac::fieldbus::test;
using testing::EndsWith;
using testing::HasSubstr;

std::string text_of(std::uint16_t id, const Bytes& bytes) {
  CanFrame frame{.id = id, .size = static_cast<std::uint8_t>(bytes.size())};
  std::copy(bytes.begin(), bytes.end(), frame.data.begin());
  return FrameDecoder().decode(frame).text;
}

CanopenConfig config_of(const Numbers& numbers, const Texts& texts = {}) {
  auto config = read_canopen_config("can0", numbers, texts, 0.001);
  EXPECT_TRUE(config.has_value()) << (config ? "" : config.error().message);
  return config.value_or(CanopenConfig());
}

TEST(FrameDecoder, TellsManagementInTheStandardsWords) {
  EXPECT_EQ(text_of(0, {0x01, 0}), "NMT start all nodes");
  EXPECT_EQ(text_of(0, {0x82, 5}), "NMT reset communication node 5");
  EXPECT_EQ(text_of(0, {0x33, 5}), "NMT unknown command node 5");
  EXPECT_EQ(text_of(0x080, {}), "SYNC");
  EXPECT_EQ(text_of(0x080, {17}), "SYNC 17");
  EXPECT_EQ(text_of(0x705, {0x00}), "boot-up node 5");
  EXPECT_EQ(text_of(0x77F, {0x05}), "heartbeat node 127: operational");
  EXPECT_EQ(text_of(0x705, {0x7F}), "heartbeat node 5: pre-operational");
  EXPECT_EQ(text_of(0x705, {0x06}), "heartbeat node 5: unknown");
  EXPECT_EQ(text_of(0x085, {0x11, 0x86, 0x21, 0, 0, 0, 0, 0}),
            "EMCY node 5: 8611h (following error), error register 21h");
  EXPECT_THAT(text_of(0x085, {0x11, 0x86, 0x21, 0, 0, 0, 0, 7}), EndsWith("of the maker 00 00 00 00 07"));
}

TEST(FrameDecoder, TellsTheLengthOfAFrameThatIsNotAsLongAsItsKind) {
  EXPECT_EQ(text_of(0, {0x01}), "NMT of 1 bytes");
  EXPECT_EQ(text_of(0, {0x01, 2, 3}), "NMT of 3 bytes");
  EXPECT_EQ(text_of(0x085, {0x11, 0x86}), "EMCY node 5 of 2 bytes");
  EXPECT_EQ(text_of(0x085, {0x11, 0x86, 0x21}), "EMCY node 5: 8611h (following error), error register 21h");
  EXPECT_EQ(text_of(0x085, {0x11, 0x86, 0x21, 0xA}),
            "EMCY node 5: 8611h (following error), error register 21h, of the maker 0A");
  EXPECT_EQ(text_of(0x705, {}), "heartbeat node 5 of 0 bytes");
  EXPECT_EQ(text_of(0x705, {5, 5}), "heartbeat node 5 of 2 bytes");
  EXPECT_EQ(text_of(0x100, {1, 2, 3, 4, 5}), "TIME of 5 bytes");
  EXPECT_EQ(text_of(0x605, {0x40}), "SDO to node 5: 1 bytes, and it has 8");
}

/// CiA 301, 7.3.5: the predefined connection set, of every identifier.
TEST(FrameDecoder, KnowsEachIdentifierByItsKindAndNode) {
  for (unsigned id = 0; id < 0x800; ++id) {
    const unsigned function = id >> 7, node = id & 0x7F;
    FrameKind kind = FrameKind::Other;
    if (id == 0) kind = FrameKind::Nmt;
    if (id == 0x80) kind = FrameKind::Sync;
    if (id == 0x100) kind = FrameKind::Time;
    if (id == 0x7E4 || id == 0x7E5) kind = FrameKind::Lss;
    if (node != 0 && function == 1) kind = FrameKind::Emergency;
    if (node != 0 && function >= 3 && function <= 10) kind = FrameKind::Pdo;
    if (node != 0 && (function == 11 || function == 12)) kind = FrameKind::Sdo;
    if (node != 0 && function == 14) kind = FrameKind::Heartbeat;
    const DecodedFrame decoded = FrameDecoder().decode({.id = static_cast<std::uint16_t>(id), .size = 8});
    ASSERT_EQ(decoded.kind, kind) << std::hex << id << " " << decoded.text;
    const bool of_node = kind == FrameKind::Emergency || kind == FrameKind::Pdo || kind == FrameKind::Sdo ||
                         kind == FrameKind::Heartbeat;
    ASSERT_EQ(decoded.node, of_node ? std::optional(static_cast<std::uint8_t>(node)) : std::nullopt) << std::hex << id;
    if (kind == FrameKind::Pdo) {
      const std::string name = (function % 2 == 1 ? "TPDO" : "RPDO") + std::to_string((function - 1) / 2);
      ASSERT_EQ(decoded.text, name + " node " + std::to_string(node) + ": 8 bytes, by a mapping that is not known");
    }
    if (kind == FrameKind::Other) {
      ASSERT_EQ(decoded.text, "outside the predefined connection set");
    }
  }
  EXPECT_EQ(FrameDecoder().decode({.id = 0, .size = 2, .data = {1, 5}}).node, 5);
  EXPECT_EQ(FrameDecoder().decode({.id = 0x85, .size = 8, .data = {0x11, 0x86}}).error_code, 0x8611);
}

TEST(FrameDecoder, NamesTheKindsForPrograms) {
  const std::array<std::pair<FrameKind, const char*>, 9> names{{{FrameKind::Nmt, "nmt"},
                                                                {FrameKind::Sync, "sync"},
                                                                {FrameKind::Time, "time"},
                                                                {FrameKind::Emergency, "emcy"},
                                                                {FrameKind::Pdo, "pdo"},
                                                                {FrameKind::Sdo, "sdo"},
                                                                {FrameKind::Heartbeat, "heartbeat"},
                                                                {FrameKind::Lss, "lss"},
                                                                {FrameKind::Other, "other"}}};
  for (const auto& [kind, name] : names) EXPECT_STREQ(to_text(kind), name);
}

TEST(FrameDecoder, TellsTheTimeThatIsSent) {
  using namespace std::chrono;
  const auto time = sys_days(year(2026) / November / 24) + hours(15) + minutes(4) + milliseconds(5007);
  FrameDecoder decoder;
  EXPECT_EQ(decoder.decode(time_frame(time)).text, "TIME 2026-11-24 15:04:05.007 UTC");
}

TEST(FrameDecoder, TellsLayerSettingServices) {
  EXPECT_EQ(text_of(0x7E5, {0x04, 1, 0, 0, 0, 0, 0, 0}), "LSS switch all nodes to configuration");
  EXPECT_EQ(text_of(0x7E5, {0x11, 5, 0, 0, 0, 0, 0, 0}), "LSS configure node id 5");
  EXPECT_EQ(text_of(0x7E4, {0x11, 0, 0, 0, 0, 0, 0, 0}), "LSS answer: configure node id: done");
  EXPECT_EQ(text_of(0x7E4, {0x13, 1, 0, 0, 0, 0, 0, 0}), "LSS answer: configure bit timing: error 1, 0");
  EXPECT_EQ(text_of(0x7E5, {0x43, 0x4D, 0, 0, 0, 0, 0, 0}), "LSS select serial number 4Dh");
  EXPECT_EQ(text_of(0x7E4, {0x5E, 5, 0, 0, 0, 0, 0, 0}), "LSS answer: inquire node id 5");
  EXPECT_EQ(text_of(0x7E5, {0x99}), "LSS command 99h, 1 bytes");
}

/// What the master packs is what is told, whichever axis of a node it is for and however a PDO is shared.
TEST(FrameDecoder, TakesPdosApartByTheMappingOfTheMachine) {
  const CanopenConfig config =
      config_of({{"node", {3, 3, 4}}, {"axis_in_node", {0, 1, 0}}, {"mode", {8}}}, {{"rpdo", "6040:00/16 607A:00/32"}});
  FrameDecoder decoder(&config);
  std::mt19937 random(3);
  for (int i = 0; i < 100; ++i) {
    for (const AxisConfig& axis : config.axes) {
      DriveCommand command;
      command.controlword = static_cast<std::uint16_t>(random());
      command.target_position_counts = static_cast<std::int32_t>(random());
      const DecodedFrame decoded = decoder.decode(pack_setpoints(axis, command));
      ASSERT_EQ(decoded.values.size(), 2U) << decoded.text;
      EXPECT_EQ(decoded.node, axis.node);
      EXPECT_EQ(decoded.values[0].object,
                (ObjectAddress{static_cast<std::uint16_t>(0x6040 + 0x800 * axis.axis_in_node), 0}));
      EXPECT_EQ(decoded.values[0].name, "Controlword");
      EXPECT_EQ(std::get<std::uint64_t>(decoded.values[0].value), command.controlword);
      EXPECT_EQ(std::get<std::int64_t>(decoded.values[1].value), command.target_position_counts);
    }
  }
}

TEST(FrameDecoder, TellsWhatAPdoHoldsInOneLine) {
  const CanopenConfig config = config_of({{"node", {3}}});
  FrameDecoder decoder(&config);
  EXPECT_EQ(decoder.decode({.id = 0x183, .size = 8, .data = {0x37, 0x06, 0xFF, 0xFF, 0xFF, 0xFF, 0x10, 0}}).text,
            "TPDO1 node 3: Statusword 0637h (operation enabled), Position actual value -1 position units, "
            "Torque actual value 16 \u2030 of rated torque");
  EXPECT_EQ(decoder.decode({.id = 0x183, .size = 7}).text, "TPDO1 node 3: shorter than what is mapped, 7 bytes");
  EXPECT_TRUE(decoder.decode({.id = 0x183, .size = 7}).values.empty());
  EXPECT_EQ(decoder.decode({.id = 0x483, .size = 4}).text, "TPDO4 node 3: 4 bytes, by a mapping that is not known");
  EXPECT_EQ(decoder.decode({.id = 0x503, .size = 4}).text, "RPDO4 node 3: 4 bytes, by a mapping that is not known");
}

TEST(FrameDecoder, TellsBothAxesThatShareAPdo) {
  const CanopenConfig config =
      config_of({{"node", {1, 2}}, {"rpdo_node", {1, 1}}}, {{"rpdo_0", "6040:00/16 6071:00/16 0007:00/32"},
                                                            {"rpdo_1", "0007:00/32 6040:00/16 6071:00/16"},
                                                            {"tpdo", "6041:00/16 6064:00/32"}});
  FrameDecoder decoder(&config);
  EXPECT_EQ(decoder.decode({.id = 0x201, .size = 8, .data = {6, 0, 1, 0, 7, 0, 2, 0}}).text,
            "RPDO1 node 1: Controlword 0006h, Target torque 1 \u2030 of rated torque, Controlword 0007h, "
            "Target torque 2 \u2030 of rated torque");
}

TEST(FrameDecoder, TellsTheSecondPdoOfSetpoints) {
  const CanopenConfig config = config_of({{"node", {1}}}, {{"second_rpdo", "60B1:00/32 60B2:00/16"}});
  FrameDecoder decoder(&config);
  const DecodedFrame decoded = decoder.decode({.id = 0x301, .size = 6, .data = {4, 0, 0, 0, 0xFE, 0xFF}});
  EXPECT_EQ(decoded.text, "RPDO2 node 1: Velocity offset 4 velocity units, Torque offset -2 \u2030 of rated torque");
}

TEST(FrameDecoder, NamesObjectsByTheSheetOfTheirNode) {
  auto sheet = std::make_shared<eds::DeviceDescription>();
  sheet->entries[{0x6064, 0}].name = "Ist-Position";
  sheet->entries[{0x6064, 0}].type = eds::DataType::Integer32;
  CanopenConfig config = config_of({{"node", {3, 4}}}, {{"tpdo", "6041:00/16 6064:00/32"}});
  config.axes.at(0).description = sheet;
  FrameDecoder decoder(&config);
  EXPECT_THAT(decoder.decode({.id = 0x183, .size = 6}).text, HasSubstr("Ist-Position 0"));
  EXPECT_THAT(decoder.decode({.id = 0x184, .size = 6}).text, HasSubstr("Position actual value 0"));
  EXPECT_THAT(decoder.decode({.id = 0x603, .size = 8, .data = {0x40, 0x64, 0x60}}).text, EndsWith("Ist-Position"));
}

class OverheardSdo : public CanopenBench {
 protected:
  void SetUp() override {
    drive_ = &wire_.add(3);
    wire_.listen = [this](const CanFrame& frame) { heard_.push_back(decoder_.decode(frame)); };
  }
  /// Runs a transfer; what was heard last is its end.
  void run(SdoClient& sdo, CanPort& port) {
    while (!sdo.finished()) {
      CanFrame frame;
      while (port.receive(frame)) {
        if (frame.id == 0x583) sdo.receive(frame, port.now());
      }
      while (sdo.next_frame(port.now(), frame)) port.send(frame);
      port.wait(std::chrono::milliseconds(1));
    }
  }
  /// The values that the dialogue had, at its end or for expedited writes at its beginning, too.
  [[nodiscard]] std::vector<std::string> told() const {
    std::vector<std::string> values;
    for (const DecodedFrame& decoded : heard_) {
      for (const DecodedValue& value : decoded.values) values.push_back(value.text);
    }
    return values;
  }

  VirtualDrive* drive_ = nullptr;
  FrameDecoder decoder_;
  std::vector<DecodedFrame> heard_;
};

std::string letters(std::size_t length, std::mt19937& random) {
  std::string text;
  for (std::size_t i = 0; i < length; ++i) text += static_cast<char>('a' + random() % 26);
  return text;
}

constexpr std::array<std::size_t, 2> kBlocksFrom{1, 1U << 20U};  // always, and never
constexpr std::array<std::size_t, 12> kLengths{1, 3, 4, 5, 7, 8, 14, 15, 40, 889, 890, 2000};

/// Expedited, segmented and by blocks, of one block and of several: the value that was carried is told, once.
TEST_F(OverheardSdo, TellsTheWholeValueThatWasRead) {
  std::mt19937 random(9);
  for (const std::size_t block_from : kBlocksFrom) {
    for (const std::size_t length : kLengths) {
      const std::string value = letters(length, random);
      drive_->set_bytes({0x1008, 0}, Bytes(value.begin(), value.end()));
      const auto port = wire_.open();
      SdoClient sdo(3, {.block_from = block_from, .block_size = 7});
      Bytes into(4000);
      heard_.clear();
      sdo.upload({0x1008, 0}, into, port->now());
      run(sdo, *port);
      ASSERT_EQ(sdo.state(), SdoClient::State::Done);
      EXPECT_EQ(told(), std::vector<std::string>{value}) << length << " bytes, blocks from " << block_from;
      EXPECT_EQ(heard_.front().text, "SDO to node 3: read 1008h:00 Manufacturer device name");
    }
  }
}

/// The listener has them, the client has not: what counts is what the client acknowledges.
TEST_F(OverheardSdo, TellsTheWholeValueWhereSegmentsOfABlockAreLost) {
  std::mt19937 random(10);
  int lost = 0;
  wire_.gateway = [&](CanFrame& frame) {
    const bool segment = (frame.data[0] & 0x7F) != 0 && (frame.data[0] & 0x7F) <= 7;
    if (!segment || random() % 8 != 0) return std::vector<CanWire::Time>{CanWire::Time(0)};
    ++lost;
    return std::vector<CanWire::Time>();
  };
  int done = 0;
  for (int i = 0; i < 50; ++i) {
    const std::string value = letters(30 + random() % 400, random);
    drive_->set_bytes({0x1008, 0}, Bytes(value.begin(), value.end()));
    const auto port = wire_.open();
    SdoClient sdo(3, {.block_from = 1, .block_size = 7});
    Bytes into(4000);
    heard_.clear();
    sdo.upload({0x1008, 0}, into, port->now());
    run(sdo, *port);
    if (sdo.state() != SdoClient::State::Done) continue;  // the last of a block was lost, and the time ran out
    ++done;
    EXPECT_EQ(told(), std::vector<std::string>{value});
  }
  EXPECT_GT(lost, 50);
  EXPECT_GT(done, 5);
}

TEST_F(OverheardSdo, TellsTheWholeValueThatWasWritten) {
  std::mt19937 random(12);
  for (const std::size_t block_from : kBlocksFrom) {
    for (const std::size_t length : kLengths) {
      const std::string value = letters(length, random);
      drive_->set_bytes({0x1008, 0}, Bytes(length));
      const auto port = wire_.open();
      SdoClient sdo(3, {.block_from = block_from, .block_size = 7});
      const Bytes bytes(value.begin(), value.end());
      heard_.clear();
      sdo.download({0x1008, 0}, bytes, port->now());
      run(sdo, *port);
      ASSERT_EQ(sdo.state(), SdoClient::State::Done);
      const auto values = told();
      ASSERT_FALSE(values.empty());
      for (const std::string& text : values) EXPECT_EQ(text, value) << length << " bytes, blocks from " << block_from;
      EXPECT_EQ(heard_.back().text, "SDO from node 3: written 1008h:00 Manufacturer device name = " + value);
    }
  }
}

TEST_F(OverheardSdo, TellsARefusalByItsText) {
  const auto port = wire_.open();
  SdoClient sdo(3);
  std::array<std::uint8_t, 4> into{};
  sdo.upload({0x5FFF, 2}, into, port->now());
  run(sdo, *port);
  EXPECT_EQ(heard_.back().text,
            "SDO from node 3: abort 5FFFh:02: object does not exist in the object dictionary (06020000h)");
  EXPECT_EQ(heard_.back().abort_code, 0x06020000U);
}

TEST(FrameDecoder, TellsNoValueOfATransferWhoseBeginningItMissed) {
  EXPECT_THAT(text_of(0x583, {0x01, 'a', 'b', 'c', 'd', 'e', 'f', 'g'}), HasSubstr("began before"));
  EXPECT_THAT(text_of(0x603, {0x60, 0, 0, 0, 0, 0, 0, 0}), HasSubstr("began before"));
  EXPECT_THAT(text_of(0x583, {0xC1, 0, 0, 0, 0, 0, 0, 0}), HasSubstr("began before"));
  EXPECT_EQ(text_of(0x583, {0x4B, 0x41, 0x60, 0, 0x50, 0x02, 0, 0}),
            "SDO from node 3: 6041h:00 Statusword = 0250h (switch on disabled)")
      << "an answer that has all is understood";
  EXPECT_THAT(text_of(0x583, {0x4B, 0x41}), HasSubstr("2 bytes, and it has 8"));
}

/// Any identifier, any length, any bytes: one line, and none of it is refused.
TEST(FrameDecoder, ReadsWhateverComes) {
  const CanopenConfig config = config_of({{"node", {1, 1, 2, 3}}, {"axis_in_node", {0, 1, 0, 0}}});
  FrameDecoder decoder(&config);
  std::mt19937 random(4);
  for (int i = 0; i < 100000; ++i) {
    CanFrame frame;
    frame.id = static_cast<std::uint16_t>(i % 2 == 0 ? random() & 0x7FF : 0x580 + 0x80 * (random() % 2) + random() % 3);
    frame.size = static_cast<std::uint8_t>(i % 4 == 0 ? random() % 9 : 8);
    for (std::uint8_t& byte : frame.data) byte = static_cast<std::uint8_t>(random());
    const DecodedFrame decoded = decoder.decode(frame);
    ASSERT_FALSE(decoded.text.empty());
    ASSERT_EQ(decoded.text.find('\n'), std::string::npos);
  }
}

}  // namespace
