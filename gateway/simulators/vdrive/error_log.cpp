#include "gateway/simulators/vdrive/error_log.hpp"

#include <algorithm>

namespace rmac::vdrive {
namespace {

constexpr std::uint8_t kListed = 8;

// Bits of the error register (7.5.2.2)
constexpr std::uint16_t kGeneric = 0x01;
constexpr std::uint16_t kTemperature = 0x08;
constexpr std::uint16_t kCommunication = 0x10;

std::uint16_t register_bits(std::uint16_t code) {
  if ((code & 0xF000U) == 0x8000 && (code & 0xFF00U) <= 0x8200) return kGeneric | kCommunication;
  return (code & 0xF000U) == 0x4000 ? kGeneric | kTemperature : kGeneric;
}

}  // namespace

void ErrorLog::note(std::uint16_t code) {
  register_ = code == 0 ? std::uint16_t{0} : static_cast<std::uint16_t>(register_ | register_bits(code));
  dictionary_.set(0x1001, register_);
  if (code == 0) return;
  // The latest error comes first.
  for (std::uint8_t sub = kListed; sub > 1; --sub) {
    dictionary_.set({0x1003, sub}, dictionary_.number(0x1003, static_cast<std::uint8_t>(sub - 1)));
  }
  dictionary_.set({0x1003, 1}, code);
  dictionary_.set(0x1003, std::min<std::int64_t>(dictionary_.number(0x1003) + 1, kListed));
}

void ErrorLog::reset_communication(bool drive_is_faulty) {
  register_ = drive_is_faulty ? static_cast<std::uint16_t>(register_ & ~kCommunication) : std::uint16_t{0};
  dictionary_.set(0x1001, register_);
}

void ErrorLog::clear_list() {
  for (std::uint8_t sub = 1; sub <= kListed; ++sub) dictionary_.set({0x1003, sub}, 0);
}

Bytes ErrorLog::emergency(std::uint16_t code) const {
  return {static_cast<std::uint8_t>(code),
          static_cast<std::uint8_t>(code >> 8),
          static_cast<std::uint8_t>(register_),
          0,
          0,
          0,
          0,
          0};
}

}  // namespace rmac::vdrive
