#include "canopen/trace/lss_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "rmac/fieldbus/canopen/sdo.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// What stands behind a command specifier (CiA 305, 3.8).
enum class Rest : std::uint8_t {
  Nothing,
  Mode,    ///< which one to switch to
  Number,  ///< a part of an identity
  Node,
  Timing,  ///< a table, and a place in it
  Delay,   ///< ms
  Scan,    ///< a part of an identity, how much of it counts, which part, which is next
};

struct Service {
  std::uint8_t command;
  const char* text;
  Rest request = Rest::Nothing;
  Rest answer = Rest::Nothing;
  bool answered_by_error = false;  ///< its answer says 0, or why not
};

constexpr std::array kServices{
    Service{0x04, "switch all nodes to", Rest::Mode},
    Service{0x11, "configure node id", Rest::Node, Rest::Nothing, true},
    Service{0x13, "configure bit timing", Rest::Timing, Rest::Nothing, true},
    Service{0x15, "activate bit timing, delay ms", Rest::Delay},
    Service{0x17, "store configuration", Rest::Nothing, Rest::Nothing, true},
    Service{0x40, "select vendor", Rest::Number},
    Service{0x41, "select product", Rest::Number},
    Service{0x42, "select revision", Rest::Number},
    Service{0x43, "select serial number", Rest::Number},
    Service{0x44, "selected"},
    Service{0x46, "identify vendor", Rest::Number},
    Service{0x47, "identify product", Rest::Number},
    Service{0x48, "identify revision from", Rest::Number},
    Service{0x49, "identify revision to", Rest::Number},
    Service{0x4A, "identify serial number from", Rest::Number},
    Service{0x4B, "identify serial number to", Rest::Number},
    Service{0x4C, "identify nodes without id"},
    Service{0x4F, "identified"},
    Service{0x50, "identified, without id"},
    Service{0x51, "fast scan", Rest::Scan},
    Service{0x5A, "inquire vendor", Rest::Nothing, Rest::Number},
    Service{0x5B, "inquire product", Rest::Nothing, Rest::Number},
    Service{0x5C, "inquire revision", Rest::Nothing, Rest::Number},
    Service{0x5D, "inquire serial number", Rest::Nothing, Rest::Number},
    Service{0x5E, "inquire node id", Rest::Nothing, Rest::Node},
};

std::string rest_text(Rest rest, const std::uint8_t* bytes) {
  switch (rest) {
    case Rest::Nothing:
      return {};
    case Rest::Mode:
      return bytes[0] == 0 ? " waiting" : bytes[0] == 1 ? " configuration" : fmt::format(" mode {}", bytes[0]);
    case Rest::Number:
      return fmt::format(" {:X}h", long_at(bytes));
    case Rest::Node:
      return bytes[0] == 0xFF ? " none" : fmt::format(" {}", bytes[0]);
    case Rest::Timing:
      return fmt::format(" {} of table {}", bytes[1], bytes[0]);
    case Rest::Delay:
      return fmt::format(" {}", word_at(bytes));
    case Rest::Scan:
      if (bytes[4] == 0x80) return ", from the beginning";
      return fmt::format(" {:X}h down to bit {} of part {}, next {}", long_at(bytes), bytes[4], bytes[5], bytes[6]);
  }
  return {};
}

}  // namespace

std::string lss_text(const CanFrame& frame) {
  const bool answer = frame.id == kLssAnswerId;
  const std::string who = answer ? "LSS answer: " : "LSS ";
  const auto* const found = std::find_if(kServices.begin(), kServices.end(), [&](const Service& service) {
    return frame.size == frame.data.size() && service.command == frame.data[0];
  });
  if (found == kServices.end()) return who + fmt::format("command {:02X}h, {} bytes", frame.data[0], frame.size);
  const std::uint8_t* rest = &frame.data[1];
  if (!answer) return who + found->text + rest_text(found->request, rest);
  if (!found->answered_by_error) return who + found->text + rest_text(found->answer, rest);
  return fmt::format("{}{}{}", who, found->text,
                     rest[0] == 0 ? ": done" : fmt::format(": error {}, {}", rest[0], rest[1]));
}

}  // namespace rmac::fieldbus::canopen
