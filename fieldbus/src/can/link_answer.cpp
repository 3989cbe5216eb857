#include "can/link_answer.hpp"

#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace rmac::fieldbus {
namespace {

using Bytes = std::span<const std::byte>;

/// The payload of the first attribute of a type; empty: there is none.
Bytes find(Bytes attributes, std::uint16_t type) noexcept {
  while (attributes.size() >= sizeof(rtattr)) {
    rtattr head{};
    std::memcpy(&head, attributes.data(), sizeof(head));
    if (head.rta_len < sizeof(head) || head.rta_len > attributes.size()) return {};
    if ((head.rta_type & NLA_TYPE_MASK) == type) return attributes.subspan(RTA_LENGTH(0), head.rta_len - RTA_LENGTH(0));
    attributes = attributes.subspan(std::min<std::size_t>(RTA_ALIGN(head.rta_len), attributes.size()));
  }
  return {};
}

template <typename Value>
std::optional<Value> read(Bytes bytes) noexcept {
  if (bytes.size() < sizeof(Value)) return {};
  Value value{};
  std::memcpy(&value, bytes.data(), sizeof(value));
  return value;
}

CanController::State state_of(std::uint32_t told) noexcept {
  using State = CanController::State;
  switch (told) {
    case CAN_STATE_ERROR_ACTIVE:
      return State::ErrorActive;
    case CAN_STATE_ERROR_WARNING:
      return State::ErrorWarning;
    case CAN_STATE_ERROR_PASSIVE:
      return State::ErrorPassive;
    case CAN_STATE_BUS_OFF:
      return State::BusOff;
    case CAN_STATE_STOPPED:
      return State::Stopped;
    case CAN_STATE_SLEEPING:
      return State::Sleeping;
    default:
      return State::Unknown;
  }
}

}  // namespace

CanController controller_of(std::span<const std::byte> answer) noexcept {
  const auto head = read<nlmsghdr>(answer);
  constexpr std::size_t kBeforeAttributes = NLMSG_SPACE(sizeof(ifinfomsg));
  if (!head || head->nlmsg_type != RTM_NEWLINK || head->nlmsg_len > answer.size() ||
      head->nlmsg_len < kBeforeAttributes) {
    return {};
  }
  const auto interface = read<ifinfomsg>(answer.subspan(NLMSG_SPACE(0)));
  CanController told;
  told.link_down = interface && (interface->ifi_flags & IFF_UP) == 0;
  const Bytes link = find(answer.first(head->nlmsg_len).subspan(kBeforeAttributes), IFLA_LINKINFO);
  const Bytes kind = find(link, IFLA_INFO_KIND);
  // Other kinds number their data otherwise.
  constexpr std::string_view kCan("can\0", 4);
  if (kind.size() != kCan.size() || std::memcmp(kind.data(), kCan.data(), kCan.size()) != 0) return told;
  const Bytes data = find(link, IFLA_INFO_DATA);
  if (const auto state = read<std::uint32_t>(find(data, IFLA_CAN_STATE))) told.state = state_of(*state);
  if (const auto errors = read<can_berr_counter>(find(data, IFLA_CAN_BERR_COUNTER))) {
    told.errors = {errors->txerr, errors->rxerr};
  }
  return told;
}

}  // namespace rmac::fieldbus
