#include "rmac/fieldbus/can/socket_can_port.hpp"

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <ctime>
#include <vector>

#include "can/error_frame.hpp"

namespace rmac::fieldbus {
namespace {

tl::unexpected<Error> trouble(const std::string& interface, const std::string& what) {
  return failure(MinorCode::CommTimeout, "CAN interface " + interface + ": " + what);
}

std::string advice(const std::string& interface) {
  return "; bring it up with systemctl enable --now rmac-can@" + interface;
}

template <typename Value>
bool set_option(int socket, int level, int name, const Value& value) {
  return setsockopt(socket, level, name, &value, sizeof(value)) == 0;
}

std::string set_filters(int socket, std::span<const std::uint16_t> wanted) {
  if (wanted.empty()) return {};
  if (wanted.size() > CAN_RAW_FILTER_MAX) {
    return "the kernel filters at most " + std::to_string(CAN_RAW_FILTER_MAX) + " identifiers, and " +
           std::to_string(wanted.size()) + " are wanted";
  }
  std::vector<can_filter> filters;
  for (const std::uint16_t id : wanted) filters.push_back({id, CAN_EFF_FLAG | CAN_RTR_FLAG | CAN_SFF_MASK});
  if (setsockopt(socket, SOL_CAN_RAW, CAN_RAW_FILTER, filters.data(),
                 static_cast<socklen_t>(filters.size() * sizeof(can_filter))) != 0) {
    return std::string("the kernel does not take the filters: ") + std::strerror(errno);
  }
  return {};
}

std::string set_options(int socket) {
  // Without CAN_ERR_PROT and the like: on a bad cable they come by the thousand, and the counters of the interface
  // (`ip -s -d link`) hold them already.
  constexpr can_err_mask_t kReports = CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL;
  if (!set_option(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, kReports) ||
      !set_option(socket, SOL_SOCKET, SO_TIMESTAMPNS, 1) || !set_option(socket, SOL_SOCKET, SO_RXQ_OVFL, 1)) {
    return std::string("the kernel refuses an option of the socket: ") + std::strerror(errno);
  }
  return {};
}

std::string check_interface(int socket, ifreq& request, std::size_t queue_frames) {
  if (ioctl(socket, SIOCGIFFLAGS, &request) != 0) return std::strerror(errno);
  if ((request.ifr_flags & IFF_UP) == 0) return "it is down" + advice(request.ifr_name);
  if (ioctl(socket, SIOCGIFTXQLEN, &request) != 0) return std::strerror(errno);
  const auto length = static_cast<std::size_t>(request.ifr_qlen);
  if (length < queue_frames) {
    return "its transmit queue holds " + std::to_string(length) + " frames, and one cycle can need " +
           std::to_string(queue_frames) + "; set TXQUEUELEN in can-" + request.ifr_name + ".conf";
  }
  return {};
}

}  // namespace

Expected<std::unique_ptr<SocketCanPort>> SocketCanPort::open(const std::string& interface,
                                                             std::span<const std::uint16_t> wanted,
                                                             std::size_t queue_frames) {
  ifreq request{};
  if (interface.empty() || interface.size() >= sizeof(request.ifr_name)) {
    return trouble(interface,
                   "an interface's name has 1 to " + std::to_string(sizeof(request.ifr_name) - 1) + " characters");
  }
  const int socket = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (socket < 0) {
    return trouble(interface, std::string("this kernel gives no raw CAN socket: ") + std::strerror(errno));
  }
  auto port = std::unique_ptr<SocketCanPort>(new SocketCanPort(socket));
  interface.copy(request.ifr_name, sizeof(request.ifr_name) - 1);
  if (ioctl(socket, SIOCGIFINDEX, &request) != 0) {
    return trouble(interface, "there is none of this name" + advice(interface));
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = port->interface_index_ = request.ifr_ifindex;
  for (const std::string& problem :
       {check_interface(socket, request, queue_frames), set_filters(socket, wanted), set_options(socket)}) {
    if (!problem.empty()) return trouble(interface, problem);
  }
  if (bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return trouble(interface, std::string("the socket cannot be bound to it: ") + std::strerror(errno));
  }
  return port;
}

SocketCanPort::~SocketCanPort() {
  close(socket_);
}

bool SocketCanPort::send(const CanFrame& frame) noexcept {
  can_frame raw{};
  raw.can_id = (frame.id & CAN_SFF_MASK) | (frame.remote ? CAN_RTR_FLAG : 0U);
  raw.can_dlc = frame.size;
  std::memcpy(raw.data, frame.data.data(), frame.data.size());
  if (write(socket_, &raw, sizeof(raw)) == static_cast<ssize_t>(sizeof(raw))) {
    ++health_.sent;
    health_.link_down = false;
    return true;
  }
  if (errno == ENOBUFS || errno == EAGAIN) {
    ++health_.queue_full;
  } else {
    ++health_.send_failures;
    take_failure(errno);
  }
  return false;
}

bool SocketCanPort::receive(CanFrame& frame) noexcept {
  // Error frames are worked off here, so that the caller sees data frames only; so many at most, for the caller has a
  // cycle to keep.
  constexpr int kMostSkipped = 64;
  for (int skipped = 0; skipped < kMostSkipped; ++skipped) {
    can_frame raw{};
    iovec part{&raw, sizeof(raw)};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timespec)) + CMSG_SPACE(sizeof(std::uint32_t))> control{};
    msghdr message{};
    message.msg_iov = &part;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket_, &message, 0);
    if (length < 0) {
      if (errno == EINTR) continue;
      if (errno != EAGAIN) take_failure(errno);
      return false;
    }
    if (length != static_cast<ssize_t>(sizeof(raw))) return false;
    frame.stamp = {};
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
      if (c->cmsg_level != SOL_SOCKET) continue;
      if (c->cmsg_type == SO_TIMESTAMPNS) {
        timespec stamp{};
        std::memcpy(&stamp, CMSG_DATA(c), sizeof(stamp));
        frame.stamp = std::chrono::seconds(stamp.tv_sec) + std::chrono::nanoseconds(stamp.tv_nsec);
      } else if (c->cmsg_type == SO_RXQ_OVFL) {
        std::uint32_t lost = 0;
        std::memcpy(&lost, CMSG_DATA(c), sizeof(lost));
        health_.overflowed = lost;
      }
    }
    if ((raw.can_id & CAN_ERR_FLAG) != 0) {
      take_error_frame(raw, health_);
      continue;
    }
    if ((raw.can_id & (CAN_EFF_FLAG | CAN_RTR_FLAG)) != 0 || raw.can_dlc > CAN_MAX_DLEN) continue;
    ++health_.received;
    health_.link_down = health_.bus_off = false;
    frame.id = static_cast<std::uint16_t>(raw.can_id & CAN_SFF_MASK);
    frame.size = raw.can_dlc;
    frame.remote = false;
    std::memcpy(frame.data.data(), raw.data, frame.data.size());
    return true;
  }
  return false;
}

void SocketCanPort::take_failure(int error) noexcept {
  if (error == ENETDOWN || error == ENXIO || error == ENODEV) health_.link_down = true;
}

void SocketCanPort::wait(std::chrono::nanoseconds at_most) noexcept {
  pollfd what{socket_, POLLIN, 0};
  const auto seconds = std::chrono::duration_cast<std::chrono::seconds>(at_most);
  const timespec limit{seconds.count(), (at_most - seconds).count()};
  (void)ppoll(&what, 1, &limit, nullptr);
}

std::chrono::nanoseconds SocketCanPort::now() const noexcept {
  timespec time{};
  clock_gettime(CLOCK_MONOTONIC, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace rmac::fieldbus
