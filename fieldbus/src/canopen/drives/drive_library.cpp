#include "rmac/fieldbus/canopen/drive_library.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace rmac::fieldbus::canopen {
namespace {

bool is_for(const DriveDescription& drive, std::uint32_t vendor_id, std::uint32_t product_code) noexcept {
  return drive.vendor_id == vendor_id && drive.product_code == product_code;
}

bool overlap(const DriveDescription& one, const DriveDescription& other) noexcept {
  return is_for(one, other.vendor_id, other.product_code) && one.first_revision <= other.last_revision &&
         other.first_revision <= one.last_revision;
}

/// Why the master cannot do without an object, or which key says that it must; empty where it can.
std::string needed(std::uint16_t index) {
  constexpr std::uint16_t kFirstPdo = 0x1400, kAfterPdos = 0x1C00, kKind = 0xFE00, kNumber = 0x1FF;
  constexpr std::array<std::uint16_t, 10> kAlways{0x1000, 0x100C, 0x100D, 0x1010, 0x1017,
                                                  0x1018, 0x6040, 0x6041, 0x6060, 0x6064};
  if (index == 0x1016) return "; a drive without it is told by NoHeartbeatConsumer";
  if (index == 0x6007) return "; a drive without it is told by NoAbortConnection";
  if (index == 0x607E) return "; where it must not be asked for, device.json gives polarity";
  if (std::find(kAlways.begin(), kAlways.end(), index) != kAlways.end()) {
    return ", without which the master cannot do";
  }
  if (index < kFirstPdo || index >= kAfterPdos) return {};
  if ((index & kKind) == 0x1600 || (index & kKind) == 0x1A00) {
    return "; a drive whose mapping cannot be written is told by FixedMapping";
  }
  const int number = index & kNumber;
  const bool by_default = number >= 1 && number <= 3;  // which are switched off
  return by_default ? "" : ", a PDO of setpoints or answers";
}

}  // namespace

const DriveDescription* DriveLibrary::find(const Identity& told) const noexcept {
  const auto found =
      std::find_if(drives.begin(), drives.end(), [&](const DriveDescription& drive) { return drive.covers(told); });
  return found == drives.end() ? nullptr : &*found;
}

const DriveDescription* DriveLibrary::find_product(std::uint32_t vendor_id, std::uint32_t product_code) const noexcept {
  const auto fits = [&](const DriveDescription& drive) { return is_for(drive, vendor_id, product_code); };
  const auto found = std::find_if(drives.begin(), drives.end(), fits);
  if (found == drives.end()) return nullptr;
  return std::any_of(std::next(found), drives.end(), fits) ? nullptr : &*found;
}

const DriveDescription* DriveLibrary::find_name(const std::string& name) const {
  const auto found = std::find_if(drives.begin(), drives.end(), [&](const DriveDescription& drive) {
    return std::filesystem::path(drive.file).stem() == name;
  });
  return found == drives.end() ? nullptr : &*found;
}

void DriveLibrary::refuse_doubles() {
  for (DriveDescription& one : drives) {
    for (const DriveDescription& other : drives) {
      if (&one == &other || !overlap(one, other)) continue;
      one.refusal = fmt::format(
          "{} and {} are for the same drive (vendor {:X}h, product {:X}h); remove one, or give them revisions apart",
          std::min(one.file, other.file), std::max(one.file, other.file), one.vendor_id, one.product_code);
    }
  }
}

Expected<> check(const DriveManners& manners) {
  for (const SkippedObject& skipped : manners.skip) {
    if (const std::string why = needed(skipped.index); !why.empty()) {
      return failure(MinorCode::InvalidParameterValue, fmt::format("/Skip names {:04X}h{}", skipped.index, why));
    }
  }
  if (manners.node_guarding && !manners.no_heartbeat_consumer.empty()) {
    return failure(
        MinorCode::InvalidParameterValue,
        "/NodeGuarding is true and /NoHeartbeatConsumer is given; a drive that is guarded knows by that that "
        "its master lives");
  }
  if (manners.fixed_mapping && manners.store_after_mapping) {
    return failure(
        MinorCode::InvalidParameterValue,
        "/StoreAfterMapping and /FixedMapping are both true; a mapping that cannot be written is not stored");
  }
  return {};
}

}  // namespace rmac::fieldbus::canopen
