#include "canopen/bus_trouble.hpp"

#include <fmt/format.h>

namespace rmac::fieldbus::canopen {

std::string BusTrouble::text(const std::string& interface) const {
  switch (kind_.load(std::memory_order_relaxed)) {
    case Kind::LinkDown:
      return fmt::format("its interface is down; bring it up with systemctl restart rmac-can@{}", interface);
    case Kind::BusOff:
      return "the controller left the bus after too many errors (bus-off); check cable, termination and bit rate";
    case Kind::OtherSync:
      return fmt::format(
          "another node sends SYNC, too, and drives act on setpoints of another cycle: a second master, or a drive "
          "that is set up for it (bit 30 of 1005h); rmac bus trace {} shows what comes. Take it off, or set sync to "
          "\"external\" where it is to pace the machine",
          interface);
    case Kind::Unsent:
      break;
  }
  return fmt::format(
      "its transmit queue was full, and {} frames were not sent since the start; nobody acknowledges them, or others "
      "fill the bus: check cable, termination and bit rate, and what rmac bus load says",
      unsent_.load(std::memory_order_relaxed));
}

}  // namespace rmac::fieldbus::canopen
