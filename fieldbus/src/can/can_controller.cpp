#include "rmac/fieldbus/can/can_controller.hpp"

#include <linux/rtnetlink.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "can/link_answer.hpp"

namespace rmac::fieldbus {

const char* to_string(CanController::State state) noexcept {
  switch (state) {
    case CanController::State::Unknown:
      break;
    case CanController::State::ErrorActive:
      return "error-active";
    case CanController::State::ErrorWarning:
      return "error-warning";
    case CanController::State::ErrorPassive:
      return "error-passive";
    case CanController::State::BusOff:
      return "bus-off";
    case CanController::State::Stopped:
      return "stopped";
    case CanController::State::Sleeping:
      return "sleeping";
  }
  return "unknown";
}

std::span<const std::byte> ask_for_link(int interface_index, std::span<std::byte> answer) noexcept {
  struct {
    nlmsghdr head;
    ifinfomsg link;
  } question{};
  question.head.nlmsg_len = NLMSG_LENGTH(sizeof(question.link));
  question.head.nlmsg_type = RTM_GETLINK;
  question.head.nlmsg_flags = NLM_F_REQUEST;
  question.link.ifi_index = interface_index;
  const int socket = ::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
  if (socket < 0) return {};
  ssize_t size = 0;
  if (send(socket, &question, question.head.nlmsg_len, 0) >= 0) {
    // The kernel answers within `send`: whoever waited here would wait for nothing.
    size = recv(socket, answer.data(), answer.size(), MSG_DONTWAIT);
  }
  close(socket);
  return answer.first(static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
}

CanController read_can_controller(int interface_index) noexcept {
  std::array<std::byte, 16384> answer{};
  return controller_of(ask_for_link(interface_index, answer));
}

}  // namespace rmac::fieldbus
