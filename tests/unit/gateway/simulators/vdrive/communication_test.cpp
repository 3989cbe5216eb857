#include <random>

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

// CiA 301: network management, heartbeats, emergencies, PDOs and the object dictionary.
namespace rmac::vdrive::test {
namespace {

using NodeCommunication = NodeBench;

constexpr std::uint32_t kReadOnly = 0x06010002;
constexpr std::uint32_t kNoObject = 0x06020000;
constexpr std::uint32_t kNotMappable = 0x06040041;
constexpr std::uint32_t kTooLongForPdo = 0x06040042;
constexpr std::uint32_t kTooLong = 0x06070012;
constexpr std::uint32_t kTooShort = 0x06070013;
constexpr std::uint32_t kNoSub = 0x06090011;
constexpr std::uint32_t kBadValue = 0x06090030;
constexpr std::uint32_t kTooHigh = 0x06090031;
constexpr std::uint32_t kStateForbids = 0x08000022;

TEST_F(NodeCommunication, SaysItsBootUpAndIsPreOperational) {
  collect();
  ASSERT_EQ(sent_.size(), 1U);
  EXPECT_EQ(sent_[0], frame(0x705, {0}));
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::PreOperational);
}

TEST_F(NodeCommunication, FollowsCommandsToItAndToAllAndNoOthers) {
  nmt(1);
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::Operational);
  receive(0, {2, kId + 1});
  receive(0, {2, kId, 0});
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::Operational);
  receive(0, {128, 0});
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::PreOperational);
  nmt(2);
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::Stopped);
  const std::size_t before = sent_.size();
  receive(0x605, {0x40, 0, 0x10, 0, 0, 0, 0, 0});
  EXPECT_EQ(sent_.size(), before) << "no SDO in Stopped";
  nmt(130);
  EXPECT_EQ(last(0x705), frame(0x705, {0}));
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::PreOperational);
}

TEST_F(NodeCommunication, TellsItsStateEveryHeartbeat) {
  EXPECT_EQ(write(0x1017, 0, 10, 2), 0U);
  const std::size_t before = count(0x705);
  pass(0.1);
  EXPECT_NEAR(static_cast<double>(count(0x705) - before), 10, 1);
  EXPECT_EQ(last(0x705), frame(0x705, {127}));
  nmt(1);
  pass(0.02);
  EXPECT_EQ(last(0x705), frame(0x705, {5}));
}

TEST_F(NodeCommunication, RefusesWritesByTheirAbortCodes) {
  EXPECT_EQ(write(0x1000, 0, 0, 4), kReadOnly);
  EXPECT_EQ(write(0x3000, 0, 0, 4), kNoObject);
  EXPECT_EQ(write(0x1017, 1, 0, 2), kNoSub);
  EXPECT_EQ(write(0x1017, 0, 0, 1), kTooShort);
  EXPECT_EQ(write(0x1017, 0, 0, 4), kTooLong);
  EXPECT_EQ(write(0x6007, 0, 4, 2), kTooHigh);
  EXPECT_EQ(write(0x6007, 0, -1, 2), 0x06090032U);
  EXPECT_EQ(write(0x6060, 0, 2, 1), kBadValue) << "a mode that it cannot do";
  EXPECT_EQ(write(0x1016, 1, 127 << 16 | 100, 4), 0U);
  EXPECT_EQ(write(0x1016, 2, 127 << 16 | 50, 4), 0x06040043U) << "the same node watched twice";
}

TEST_F(NodeCommunication, AbortsBlockTransfersThatBreakTheProtocol) {
  const auto ask = [this](const Bytes& request) {
    receive(0x600 + kId, request);
    return last(0x580 + kId);
  };
  for (const int size : {0, 128}) {
    EXPECT_EQ(ask({0xA4, 0x08, 0x10, 0, 127, 0, 0, 0}).data[0] & 0xE1, 0xC0) << "the name of the device, in blocks";
    EXPECT_EQ(ask({0xA3, 0, 0, 0, 0, 0, 0, 0}).data[0], 0x82) << "two segments, the last one";
    EXPECT_EQ(number(ask({0xA2, 2, static_cast<std::uint8_t>(size), 0, 0, 0, 0, 0}), 4, 4), 0x05040002U);
  }
  EXPECT_EQ(ask({0xC6, 0x85, 0x60, 0, 4, 0, 0, 0}).data[0] & 0xE3, 0xA0);
  EXPECT_EQ(number(ask({0x00, 1, 2, 3, 4, 0, 0, 0}), 4, 4), 0x05040003U) << "segments count from 1";
}

TEST_F(NodeCommunication, TakesABlockWhoseChecksumIsRightAndNoOther) {
  const auto ask = [this](const Bytes& request) {
    receive(0x600 + kId, request);
    return last(0x580 + kId);
  };
  // CRC-16-CCITT from 0 of 01 02 03 04, by another implementation (binascii.crc_hqx).
  constexpr std::uint16_t kChecksum = 0x0D03;
  const std::int64_t before = read(0x6085);
  for (const int wrong : {0x0001, 0x0100, 0x8000, 0}) {
    EXPECT_EQ(ask({0xC6, 0x85, 0x60, 0, 4, 0, 0, 0}).data[0] & 0xE3, 0xA0);
    EXPECT_EQ(ask({0x81, 1, 2, 3, 4, 0, 0, 0}).data[0], 0xA2);
    const auto told = static_cast<std::uint16_t>(kChecksum ^ wrong);
    const CanFrame answer =
        ask({0xCD, static_cast<std::uint8_t>(told), static_cast<std::uint8_t>(told >> 8), 7, 7, 7, 7, 7});  // reserved
    if (wrong != 0) {
      EXPECT_EQ(number(answer, 4, 4), 0x05040004U) << wrong;
      EXPECT_EQ(read(0x6085), before) << "nothing of it counts";
    }
  }
  EXPECT_EQ(read(0x6085), 0x04030201);
}

TEST_F(NodeCommunication, ChangesAMappingInTheStandardsOrderOnly) {
  EXPECT_EQ(write(0x1600, 0, 0, 1), kStateForbids) << "the PDO is valid";
  EXPECT_EQ(write(0x1400, 1, 0x206, 4), kBadValue) << "the identifier of a PDO that is valid";
  EXPECT_EQ(write(0x1400, 1, 0x80000205, 4), 0U);
  EXPECT_EQ(write(0x1600, 1, 0x607A0020, 4), kStateForbids) << "there are entries";
  EXPECT_EQ(write(0x1600, 0, 0, 1), 0U);
  EXPECT_EQ(write(0x1600, 1, 0x60660010, 4), kNotMappable);
  EXPECT_EQ(write(0x1600, 1, 0x60640020, 4), kNotMappable) << "read only";
  EXPECT_EQ(write(0x1600, 1, 0x607A0010, 4), kNotMappable) << "of another length";
  EXPECT_EQ(write(0x1600, 1, 0x607B0020, 4), kNoObject);
  for (std::uint8_t sub = 1; sub <= 3; ++sub) EXPECT_EQ(write(0x1600, sub, 0x607A0020, 4), 0U);
  EXPECT_EQ(write(0x1600, 0, 3, 1), kTooLongForPdo);
  EXPECT_EQ(write(0x1600, 0, 9, 1), kTooLongForPdo);
  EXPECT_EQ(write(0x1600, 0, 2, 1), 0U);
  for (const std::uint32_t id : {0x000U, 0x101U, 0x580U + 1, 0x601U, 0x705U, 0x7FFU}) {
    EXPECT_EQ(write(0x1400, 1, id, 4), kBadValue) << id;
  }
  EXPECT_EQ(write(0x1400, 1, 0x20000205, 4), kBadValue) << "29 bits";
  EXPECT_EQ(write(0x1400, 1, 0x205, 4), 0U);
}

/// Lays out a pair of PDOs for SYNC: controlword and position, statusword and position.
class NodePdos : public NodeBench {
 protected:
  void map(std::uint16_t communication, std::uint32_t id, std::initializer_list<std::uint32_t> entries, int type = 1) {
    const auto contents = static_cast<std::uint16_t>(communication + 0x200);
    EXPECT_EQ(write(communication, 1, 0x80000000 | id, 4), 0U);
    EXPECT_EQ(write(communication, 2, type, 1), 0U);
    EXPECT_EQ(write(contents, 0, 0, 1), 0U);
    std::uint8_t sub = 0;
    for (const std::uint32_t entry : entries) EXPECT_EQ(write(contents, ++sub, entry, 4), 0U);
    EXPECT_EQ(write(contents, 0, sub, 1), 0U);
    EXPECT_EQ(write(communication, 1, id, 4), 0U);
  }
  void map_both() {
    map(0x1400, 0x205, {0x60400010, 0x607A0020});
    map(0x1800, 0x40000185, {0x60410010, 0x60640020});
    EXPECT_EQ(write(0x1801, 1, 0xC0000285, 4), 0U);
    EXPECT_EQ(write(0x1401, 1, 0x80000305, 4), 0U);
  }
};

TEST_F(NodePdos, ActOnSyncAndTellWithIt) {
  map_both();
  nmt(1);
  receive(0x205, {0x06, 0, 1, 2, 3, 4});
  EXPECT_EQ(read(0x607A), 0) << "before SYNC nothing acts";
  receive(0x205, {0x06, 0, 9, 0, 0, 0});
  sync();
  EXPECT_EQ(read(0x607A), 9) << "the latest setpoint wins";
  EXPECT_EQ(count(0x185), 1U);
  EXPECT_EQ(last(0x185).size, 6);
  EXPECT_EQ(number(last(0x185), 0, 2) & 0x6F, 0x21U);
  pass(0.01);
  EXPECT_EQ(count(0x185), 1U) << "nothing without SYNC";
}

TEST_F(NodePdos, AreNotServedOutsideOfOperational) {
  map_both();
  receive(0x205, {0x06, 0, 9, 0, 0, 0});
  sync();
  EXPECT_EQ(count(0x185), 0U);
  EXPECT_EQ(read(0x607A), 0);
}

TEST_F(NodePdos, OfAWrongLengthAreReported) {
  map_both();
  nmt(1);
  receive(0x205, {0x06, 0, 9});
  sync();
  EXPECT_EQ(number(last(0x085), 0, 2), 0x8210U);
  EXPECT_EQ(read(0x607A), 0) << "too short: not processed";
  receive(0x205, {0x06, 0, 9, 0, 0, 0, 7});
  sync();
  EXPECT_EQ(number(last(0x085), 0, 2), 0x8220U);
  EXPECT_EQ(read(0x607A), 9) << "too long: the first bytes count";
  EXPECT_EQ(read(0x1003, 0), 2);
  EXPECT_EQ(read(0x1003, 1), 0x8220);
  EXPECT_EQ(write(0x1003, 0, 1, 1), 0x06090031U);
  EXPECT_EQ(write(0x1003, 0, 0, 1), 0U);
}

TEST_F(NodePdos, TellWithEverySecondSyncOrOnChange) {
  map(0x1800, 0x40000185, {0x60610008}, 2);
  map(0x1801, 0x40000285, {0x60610008}, 0);
  map(0x1802, 0x40000385, {0x60610008}, 255);
  nmt(1);
  pass(0.001);
  for (int i = 0; i < 10; ++i) sync();
  EXPECT_EQ(count(0x185), 5U);
  EXPECT_EQ(count(0x285), 1U);
  EXPECT_EQ(count(0x385), 1U) << "once when it became operational";
  EXPECT_EQ(write(0x6060, 0, 8, 1), 0U);
  pass(0.05);
  sync();
  EXPECT_EQ(count(0x285), 2U);
  EXPECT_EQ(count(0x385), 2U);
}

TEST_F(NodePdos, TakeDummiesForRoom) {
  map(0x1400, 0x205, {0x00060010, 0x607A0020}, 255);
  nmt(1);
  receive(0x205, {0xFF, 0xFF, 9, 0, 0, 0});
  EXPECT_EQ(read(0x607A), 9) << "transmission type 255 acts at once";
}

TEST_F(NodeCommunication, MissesItsMastersHeartbeatAndQuickStops) {
  EXPECT_EQ(write(0x6007, 0, 3, 2), 0U);
  EXPECT_EQ(write(0x605A, 0, 6, 2), 0U);
  EXPECT_EQ(write(0x1016, 1, 127 << 16 | 50, 4), 0U);
  nmt(1);
  enable(3);
  pass(0.2);
  EXPECT_EQ(count(0x085), 0U) << "it watches from the first heartbeat on";
  receive(0x77F, {5});
  pass(0.049);
  EXPECT_EQ(state(), 0x27);
  pass(0.003);
  EXPECT_EQ(state(), 0x07) << "quick stop active";
  EXPECT_EQ(node_.nmt_state(), Node::NmtState::PreOperational);
  EXPECT_EQ(number(last(0x085), 0, 2), 0x8130U);
  EXPECT_EQ(last(0x085).data[2], 0x11) << "generic and communication error";
}

// CiA 301, 7.5.2.21: what a node does of which NMT state that misses a heartbeat.
TEST_F(NodeCommunication, FollowsItsErrorBehaviorWhenItMissesAHeartbeat) {
  using State = Node::NmtState;
  struct Case {
    int behavior;
    std::uint8_t command;
    State before, after;
  };
  constexpr int kAsInTheSheet = -1;
  for (const Case& each :
       {Case{kAsInTheSheet, 1, State::Operational, State::PreOperational},
        Case{0, 1, State::Operational, State::PreOperational}, Case{0, 2, State::Stopped, State::Stopped},
        Case{1, 1, State::Operational, State::Operational}, Case{2, 1, State::Operational, State::Stopped},
        Case{2, 0x80, State::PreOperational, State::Stopped}}) {
    SCOPED_TRACE(testing::Message() << each.behavior << " command " << int{each.command});
    nmt(0x82);
    pass(0.001);
    if (each.behavior != kAsInTheSheet) {
      EXPECT_EQ(write(0x1029, 1, each.behavior, 1), 0U);
    }
    EXPECT_EQ(write(0x1016, 1, 127 << 16 | 50, 4), 0U);
    nmt(each.command);
    receive(0x77F, {5});
    pass(0.049);
    EXPECT_EQ(node_.nmt_state(), each.before);
    pass(0.003);
    EXPECT_EQ(node_.nmt_state(), each.after);
  }
}

TEST_F(NodeCommunication, KeepsWhatWasStoredOverAReset) {
  EXPECT_EQ(write(0x1010, 1, 1, 4), 0x08000020U);
  EXPECT_EQ(write(0x6081, 0, 4711, 4), 0U);
  EXPECT_EQ(write(0x1010, 1, 0x65766173, 4), 0U);
  EXPECT_EQ(write(0x6083, 0, 815, 4), 0U);
  nmt(129);
  EXPECT_EQ(read(0x6081), 4711);
  EXPECT_EQ(read(0x6083), 13107200);
  EXPECT_EQ(write(0x1011, 1, 0x64616F6C, 4), 0U);
  EXPECT_EQ(read(0x6081), 4711) << "until the next reset";
  nmt(129);
  EXPECT_EQ(read(0x6081), 1310720);
}

TEST_F(NodeCommunication, ResetsItsCommunicationAlone) {
  EXPECT_EQ(write(0x6081, 0, 4711, 4), 0U);
  EXPECT_EQ(write(0x1017, 0, 100, 2), 0U);
  nmt(130);
  EXPECT_EQ(read(0x6081), 4711);
  EXPECT_EQ(read(0x1017), 0);
}

TEST_F(NodeCommunication, IsWhatItsDataSheetSays) {
  for (const auto& [address, entry] : sheet().entries) {
    Bytes bytes;
    ASSERT_EQ(node_.dictionary().read(address, bytes), 0U) << fieldbus::to_string(address);
    if (bytes_of(entry.type) == 0) continue;
    EXPECT_EQ(bytes.size(), bytes_of(entry.type)) << fieldbus::to_string(address);
  }
}

TEST_F(NodeCommunication, ShowsFaultsOnDemand) {
  nmt(1);
  node_.outlet().set_mute(true);
  receive(0x605, {0x2B, 0x17, 0x10, 0, 10, 0, 0, 0});
  const std::size_t before = sent_.size();
  pass(0.1);
  EXPECT_EQ(sent_.size(), before);
  node_.outlet().set_mute(false);
  pass(0.02);
  EXPECT_GT(sent_.size(), before);
  node_.outlet().set_delay(std::chrono::milliseconds(30));
  pass(0.05);
  const std::size_t delayed = count(0x585);
  receive(0x605, {0x40, 0, 0x10, 0, 0, 0, 0, 0});
  pass(0.029);
  EXPECT_EQ(count(0x585), delayed);
  pass(0.003);
  EXPECT_EQ(count(0x585), delayed + 1);
}

TEST_F(NodeCommunication, StaysCalmWhateverFramesCome) {
  std::mt19937 random(301);  // NOLINT: the same frames in every run
  constexpr std::array<std::uint16_t, 6> kIds{0x000, 0x080, 0x205, 0x305, 0x605, 0x77F};
  for (int i = 0; i < 50000; ++i) {
    CanFrame noise;
    noise.id = random() % 4 == 0 ? static_cast<std::uint16_t>(random() & 0x7FF) : kIds.at(random() % kIds.size());
    noise.size = static_cast<std::uint8_t>(random() % 9);
    for (auto& byte : noise.data) byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() % 8 * 0x20 : random());
    if (noise.id == 0x605 && random() % 2 == 0) {  // an object that it has
      noise.size = 8;
      auto entry = sheet().entries.begin();
      std::advance(entry, static_cast<std::ptrdiff_t>(random() % sheet().entries.size()));
      noise.data[0] = static_cast<std::uint8_t>(0x23 | (random() % 4) << 2);
      noise.data[1] = static_cast<std::uint8_t>(entry->first.index);
      noise.data[2] = static_cast<std::uint8_t>(entry->first.index >> 8);
      noise.data[3] = entry->first.sub;
    }
    node_.receive(noise, now_);
    if (i % 50 == 0) pass(0.001);
    collect();
    for (const CanFrame& out : sent_) ASSERT_LE(out.size, 8);
    sent_.clear();
  }
  nmt(129);
  EXPECT_EQ(last(0x705), frame(0x705, {0}));
}

}  // namespace
}  // namespace rmac::vdrive::test
