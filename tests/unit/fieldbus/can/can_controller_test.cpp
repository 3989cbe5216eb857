#include "rmac/fieldbus/can/can_controller.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>
#include <linux/can/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <array>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "can/error_frame.hpp"
#include "can/link_answer.hpp"

namespace rmac::fieldbus {
namespace {

using State = CanController::State;
using RawBytes = std::vector<std::byte>;

template <typename Value>
RawBytes bytes_of(const Value& value) {
  RawBytes bytes(sizeof(value));
  std::memcpy(bytes.data(), &value, sizeof(value));
  return bytes;
}

RawBytes text(const std::string& words) {
  RawBytes bytes(words.size() + 1);
  std::memcpy(bytes.data(), words.c_str(), bytes.size());
  return bytes;
}

RawBytes operator+(RawBytes left, const RawBytes& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

RawBytes attribute(unsigned short type, const RawBytes& payload) {
  RawBytes bytes = bytes_of(rtattr{static_cast<unsigned short>(RTA_LENGTH(payload.size())), type}) + payload;
  bytes.resize(RTA_ALIGN(bytes.size()));
  return bytes;
}

/// As rtnl_fill_ifinfo builds it: a name before, statistics behind.
RawBytes answer(const std::string& kind, const RawBytes& data, unsigned flags = IFF_UP) {
  ifinfomsg interface {};
  interface.ifi_flags = flags;
  const RawBytes body =
      bytes_of(interface) + attribute(IFLA_IFNAME, text("can0")) +
      attribute(IFLA_LINKINFO, attribute(IFLA_INFO_KIND, text(kind)) + attribute(IFLA_INFO_XSTATS, RawBytes(24)) +
                                   attribute(IFLA_INFO_DATA | NLA_F_NESTED, data)) +
      attribute(IFLA_MTU, bytes_of(16U));
  nlmsghdr head{};
  head.nlmsg_len = static_cast<unsigned>(NLMSG_LENGTH(body.size()));
  head.nlmsg_type = RTM_NEWLINK;
  return bytes_of(head) + body;
}

RawBytes controller(std::uint32_t state, can_berr_counter errors) {
  return attribute(IFLA_CAN_BITTIMING, RawBytes(32)) + attribute(IFLA_CAN_STATE, bytes_of(state)) +
         attribute(IFLA_CAN_BERR_COUNTER, bytes_of(errors));
}

// Red when only real controllers are told to be down, or others too.
TEST(CanController, IsDownWithItsInterface) {
  for (const char* kind : {"can", "vcan"}) {
    const RawBytes data = controller(CAN_STATE_ERROR_ACTIVE, {});
    EXPECT_FALSE(controller_of(answer(kind, data, IFF_UP | IFF_RUNNING)).link_down);
    EXPECT_TRUE(controller_of(answer(kind, data, IFF_RUNNING)).link_down);
  }
  EXPECT_FALSE(controller_of({}).link_down) << "nobody says so";
}

TEST(CanController, IsWhatTheKernelTells) {
  const std::vector<std::pair<std::uint32_t, State>> states{{CAN_STATE_ERROR_ACTIVE, State::ErrorActive},
                                                            {CAN_STATE_ERROR_WARNING, State::ErrorWarning},
                                                            {CAN_STATE_ERROR_PASSIVE, State::ErrorPassive},
                                                            {CAN_STATE_BUS_OFF, State::BusOff},
                                                            {CAN_STATE_STOPPED, State::Stopped},
                                                            {CAN_STATE_SLEEPING, State::Sleeping},
                                                            {CAN_STATE_MAX, State::Unknown}};
  for (const auto& [told, state] : states) {
    const CanController read = controller_of(answer("can", controller(told, {.txerr = 128, .rxerr = 7})));
    EXPECT_EQ(read.state, state) << told;
    ASSERT_TRUE(read.errors);
    EXPECT_EQ(read.errors->transmit, 128);
    EXPECT_EQ(read.errors->receive, 7);
  }
}

TEST(CanController, HasNoCountersWhereTheDriverTellsNone) {
  const CanController read =
      controller_of(answer("can", attribute(IFLA_CAN_STATE, bytes_of(std::uint32_t{CAN_STATE_BUS_OFF}))));
  EXPECT_EQ(read.state, State::BusOff);
  EXPECT_FALSE(read.errors);
}

TEST(CanController, IsUnknownWhereThereIsNone) {
  // Another kind of link numbers its data otherwise: what stands at the same place is no state.
  const CanController read = controller_of(answer("vcan", controller(CAN_STATE_ERROR_PASSIVE, {200, 200})));
  EXPECT_EQ(read.state, State::Unknown);
  EXPECT_FALSE(read.errors);
  EXPECT_EQ(controller_of({}).state, State::Unknown);
  EXPECT_EQ(read_can_controller(static_cast<int>(if_nametoindex("lo"))).state, State::Unknown);
  EXPECT_EQ(read_can_controller(0x7FFFFFFF).state, State::Unknown) << "no such interface";
}

TEST(CanController, IsAskedForByItsInterface) {
  const int loopback = static_cast<int>(if_nametoindex("lo"));
  if (loopback == 0) GTEST_SKIP() << "no interface to ask for";
  std::array<std::byte, 16384> room{};
  const auto told = ask_for_link(loopback, room);
  nlmsghdr head{};
  ifinfomsg link{};
  ASSERT_GE(told.size(), NLMSG_LENGTH(sizeof(link)));
  std::memcpy(&head, told.data(), sizeof(head));
  std::memcpy(&link, told.data() + NLMSG_LENGTH(0), sizeof(link));
  EXPECT_EQ(head.nlmsg_type, RTM_NEWLINK);
  EXPECT_EQ(link.ifi_index, loopback);
  const auto refused = ask_for_link(0x7FFFFFFF, room);
  ASSERT_GE(refused.size(), sizeof(head));
  std::memcpy(&head, refused.data(), sizeof(head));
  EXPECT_EQ(head.nlmsg_type, NLMSG_ERROR) << "no such interface";
}

TEST(CanController, IsReadFromTheAnswerToTheQuestionAlone) {
  RawBytes other = answer("can", controller(CAN_STATE_ERROR_PASSIVE, {1, 2}));
  nlmsghdr head{};
  std::memcpy(&head, other.data(), sizeof(head));
  head.nlmsg_type = RTM_DELLINK;
  std::memcpy(other.data(), &head, sizeof(head));
  EXPECT_EQ(controller_of(other).state, State::Unknown) << "a link that goes away";
}

TEST(CanController, HasAStateInWords) {
  const std::vector<std::pair<State, std::string>> words{{State::Unknown, "unknown"},
                                                         {State::ErrorActive, "error-active"},
                                                         {State::ErrorWarning, "error-warning"},
                                                         {State::ErrorPassive, "error-passive"},
                                                         {State::BusOff, "bus-off"},
                                                         {State::Stopped, "stopped"},
                                                         {State::Sleeping, "sleeping"}};
  for (const auto& [state, text] : words) EXPECT_EQ(to_string(state), text);
}

TEST(CanController, StandsAnAnswerThatIsCutShortOrSpoilt) {
  const RawBytes whole = answer("can", controller(CAN_STATE_ERROR_ACTIVE, {1, 2}));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A copy of its own, so that a read behind it is one behind its end.
    EXPECT_EQ(controller_of(RawBytes(whole.begin(), whole.begin() + static_cast<long>(size))).state, State::Unknown);
  }
  std::mt19937 random(20);
  for (int round = 0; round < 20000; ++round) {
    RawBytes spoilt = whole;
    for (int i = 0; i < 3; ++i) spoilt[random() % spoilt.size()] = static_cast<std::byte>(random());
    static_cast<void>(controller_of(spoilt));
  }
}

CanHealth after(std::initializer_list<std::pair<canid_t, unsigned>> reports) {
  CanHealth health;
  for (const auto& [classes, details] : reports) {
    can_frame report{};
    report.can_id = CAN_ERR_FLAG | classes;
    report.data[1] = static_cast<std::uint8_t>(details);
    take_error_frame(report, health);
  }
  return health;
}

TEST(CanErrorFrame, CountsHowFarTheControllerGot) {
  const CanHealth health = after({{CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING},
                                  {CAN_ERR_CRTL | CAN_ERR_CNT, CAN_ERR_CRTL_RX_WARNING},
                                  {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_RX_WARNING},
                                  {CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE | CAN_ERR_CRTL_RX_PASSIVE},
                                  {CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE},
                                  {CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW},
                                  {CAN_ERR_PROT, CAN_ERR_CRTL_RX_PASSIVE}});  // not of the class that fills the byte
  EXPECT_EQ(health.error_frames, 7U);
  EXPECT_EQ(health.warnings, 3U);
  EXPECT_EQ(health.passives, 1U);
  EXPECT_TRUE(health.usable());
}

TEST(CanErrorFrame, TellsThatTheControllerLeftTheBusUntilItIsRestarted) {
  EXPECT_FALSE(after({{CAN_ERR_BUSOFF, 0}}).usable());
  const CanHealth health =
      after({{CAN_ERR_BUSOFF, 0}, {CAN_ERR_RESTARTED, 0}, {CAN_ERR_BUSOFF, 0}, {CAN_ERR_RESTARTED, 0}});
  EXPECT_EQ(health.bus_offs, 2U);
  EXPECT_TRUE(health.usable());
}

}  // namespace
}  // namespace rmac::fieldbus
