#include <gmock/gmock.h>

#include <cstdlib>
#include <random>

#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"
#include "rmac/fieldbus/canopen/lss.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"
#include "rmac/fieldbus/canopen/stored_parameters.hpp"

// The master's services against canopen_node.py, which shares no code with it and is on python3-can:
//   canopen_node.py vcan0 5:1000 7 0x80000001
namespace {

using namespace rmac;
using namespace rmac::fieldbus;
using namespace rmac::fieldbus::canopen;
using Bytes = std::vector<std::uint8_t>;
using std::chrono::milliseconds;

constexpr std::uint8_t kNode = 5;
constexpr ObjectAddress kData{0x2000, 0}, kReadOnly{0x2002, 0}, kWriteOnly{0x2003, 0}, kWord{0x2004, 0};

/// As canopen_node.py tells them.
Identity identity(std::uint32_t serial) {
  return {0x2A5, 0x80000077, 0x10002, serial};
}

class CanopenWithPython : public testing::Test {
 protected:
  CanopenWithPython() {
    const char* name = std::getenv("RMAC_CAN_INTERFACE");
    auto port = SocketCanPort::open(name != nullptr ? name : "vcan0", {}, 1);
    EXPECT_TRUE(port.has_value()) << port.error().message;
    port_ = std::move(*port);
  }

  SdoClient::State finish(SdoClient& sdo, std::uint8_t node) {
    while (!sdo.finished()) {
      CanFrame frame;
      while (port_->receive(frame)) {
        if (frame.id == kSdoAnswerId + node) sdo.receive(frame, port_->now());
      }
      while (sdo.next_frame(port_->now(), frame)) port_->send(frame);
      port_->wait(milliseconds(1));
    }
    abort_code_ = sdo.abort_code();
    return sdo.state();
  }
  SdoClient::State download(ObjectAddress object, const Bytes& data, std::uint8_t node = kNode) {
    SdoClient sdo(node, options_);
    sdo.download(object, data, port_->now());
    return finish(sdo, node);
  }
  std::optional<Bytes> upload(ObjectAddress object, std::size_t room, std::uint8_t node = kNode) {
    Bytes bytes(room);
    SdoClient sdo(node, options_);
    sdo.upload(object, bytes, port_->now());
    if (finish(sdo, node) != SdoClient::State::Done) return {};
    bytes.resize(sdo.size());
    return bytes;
  }
  /// How the server goes about its transfers (2001h).
  void have_server(std::uint8_t block_size, bool blocks, bool sizes, bool crc) {
    const std::array<std::uint8_t, 4> values{block_size, blocks, sizes, crc};
    for (std::uint8_t i = 0; i < values.size(); ++i) {
      ASSERT_EQ(download({0x2001, static_cast<std::uint8_t>(i + 1)}, {values.at(i)}), SdoClient::State::Done);
    }
  }

  std::unique_ptr<SocketCanPort> port_;
  SdoClient::Options options_{.timeout = std::chrono::seconds(2)};
  std::uint32_t abort_code_ = 0;
};

TEST_F(CanopenWithPython, CarriesDataOfEachLengthInEachWayOfTransfer) {
  std::mt19937 random(301);  // NOLINT(cert-msc51-cpp): the same data every time
  int transfers = 0;
  for (const bool blocks : {true, false}) {
    for (const auto block_size : std::initializer_list<std::uint8_t>{127, 1, 10}) {
      have_server(block_size, blocks, random() % 2 == 0, random() % 2 == 0);
      options_.block_size = block_size;
      for (const std::size_t size : {1U, 3U, 4U, 5U, 7U, 8U, 14U, 29U, 70U, 71U, 889U, 890U, 2000U}) {
        Bytes data(size);
        for (auto& byte : data) byte = static_cast<std::uint8_t>(random());
        ASSERT_EQ(download(kData, data), SdoClient::State::Done) << size << " bytes, abort " << std::hex << abort_code_;
        ASSERT_EQ(upload(kData, size + random() % 40), data) << size << " bytes, abort " << std::hex << abort_code_;
        transfers += 2;
      }
    }
  }
  std::printf("%d transfers\n", transfers);
}

TEST_F(CanopenWithPython, IsToldWhyTheNodeRefuses) {
  have_server(127, true, true, true);
  EXPECT_FALSE(upload({0x5F00, 0}, 4));
  EXPECT_STREQ(sdo_abort_text(abort_code_), "object does not exist in the object dictionary");
  EXPECT_FALSE(upload({0x1018, 9}, 4));
  EXPECT_STREQ(sdo_abort_text(abort_code_), "sub-index does not exist");
  EXPECT_FALSE(upload(kWriteOnly, 4));
  EXPECT_EQ(abort_code_, 0x06010001U);
  EXPECT_EQ(download(kReadOnly, {1, 2}), SdoClient::State::Refused);
  EXPECT_EQ(abort_code_, 0x06010002U);
  EXPECT_EQ(download(kWord, {1}), SdoClient::State::Refused);
  EXPECT_EQ(abort_code_, 0x06070013U);
  EXPECT_EQ(download(kWord, Bytes(100)), SdoClient::State::Refused) << "a block transfer that is too long";
  EXPECT_EQ(abort_code_, 0x06070012U);
  EXPECT_EQ(download(kWord, {0xFF, 0xFF}), SdoClient::State::Refused);
  EXPECT_EQ(abort_code_, 0x06090031U);
  EXPECT_EQ(download(kWord, {0xE8, 0x03}), SdoClient::State::Done);
  EXPECT_EQ(upload(kWord, 2), (Bytes{0xE8, 0x03})) << "and goes on afterwards";
}

TEST_F(CanopenWithPython, FindsWhoItIsAndHasItStore) {
  const auto found = scan_bus(*port_);
  ASSERT_TRUE(found) << found.error().message;
  ASSERT_EQ(found->size(), 1U);
  EXPECT_EQ(found->front().node, kNode);
  EXPECT_EQ(found->front().identity.serial_number, 1000U);
  EXPECT_EQ(found->front().identity.product_code, 0x80000077U);
  EXPECT_EQ(found->front().name, "a node in Python, on python3-can");
  const auto stored = store_parameters(*port_, kNode, StoreCommand::Save);
  EXPECT_TRUE(stored) << stored.error().message;
  const auto refused = store_parameters(*port_, kNode, StoreCommand::LoadDefaults);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("node 5 refused 1011h:01: object does not exist"));
}

// One after the other: nodes that have an id keep it.
TEST_F(CanopenWithPython, GivesIdsAndABitRateOverTheBus) {
  const auto found = lss_scan(*port_);
  ASSERT_TRUE(found) << found.error().message;
  std::vector<std::uint32_t> serials;
  for (const Identity& node : *found) {
    EXPECT_EQ(node.vendor_id, 0x2A5U);
    EXPECT_EQ(node.product_code, 0x80000077U);
    EXPECT_EQ(node.revision_number, 0x10002U);
    serials.push_back(node.serial_number);
  }
  EXPECT_THAT(serials, testing::UnorderedElementsAre(7U, 0x80000001U));
  EXPECT_FALSE(lss_assign(*port_, 9, {})) << "there are two";
  const auto first = lss_assign(*port_, 9, identity(7));
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_TRUE(first->stored);
  const auto second = lss_assign(*port_, 10, {});
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(second->identity.serial_number, 0x80000001U);
  const auto again = lss_assign(*port_, 11, identity(7));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(upload({0x1018, 4}, 4, 11), (Bytes{7, 0, 0, 0}));
  const auto taken = lss_assign(*port_, 10, identity(7));
  ASSERT_FALSE(taken);
  EXPECT_EQ(taken.error().message, "node 10 is there already; give this one another id");

  const std::vector<Identity> all{identity(1000), identity(7), identity(0x80000001)};
  const auto refused = lss_set_bit_rate(*port_, all, 10'000, milliseconds(100));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("no node changes now"));
  const auto changed = lss_set_bit_rate(*port_, all, 250'000, milliseconds(500));
  ASSERT_TRUE(changed) << changed.error().message;
  options_.timeout = milliseconds(200);
  EXPECT_FALSE(upload({0x1000, 0}, 4, 11)) << "nobody speaks between two bit rates";
  options_.timeout = std::chrono::seconds(2);
  for (const auto until = port_->now() + std::chrono::seconds(1); port_->now() < until;) port_->wait(milliseconds(10));
  for (const std::uint8_t node : {kNode, std::uint8_t{10}, std::uint8_t{11}}) {
    EXPECT_EQ(upload({0x2005, 0}, 1, node), Bytes{3}) << "250 kbit/s is 3 in the standard's table";
  }
}

}  // namespace
