#include "canopen/watch/identity_record.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// The value of an expedited upload (CiA 301, 7.2.4.3.3), in which all of these objects come.
std::optional<std::uint32_t> expedited_value(const CanFrame& frame) noexcept {
  constexpr std::uint8_t kCommand = 0xE0, kUpload = 0x40, kExpedited = 0x02, kSizeTold = 0x01;
  const std::uint8_t command = frame.data[0];
  if (frame.size != 8 || (command & kCommand) != kUpload || (command & kExpedited) == 0) return {};
  const unsigned unused = (command & kSizeTold) != 0 ? command >> 2 & 3U : 0;
  return long_at(&frame.data[4]) & (0xFFFFFFFFU >> (8 * unused));
}

}  // namespace

std::optional<IdentityRecord::Contradiction> IdentityRecord::take(const CanFrame& frame) noexcept {
  const auto value = expedited_value(frame);
  if (!value) return {};
  const ObjectAddress object{word_at(&frame.data[1]), frame.data[3]};
  const bool type = object.index == 0x1000 && object.sub == 0;
  const bool identity = object.index == 0x1018 && object.sub >= 1 && object.sub < told_.size();
  if (!type && !identity) return {};
  std::optional<std::uint32_t>& told = told_[object.sub];
  if (!told) told = value;
  if (*told == *value) return {};
  return Contradiction{object, *told, *value};
}

}  // namespace rmac::fieldbus::canopen
