#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/drive_library.hpp"
#include "rmac/fieldbus/canopen/sdo.hpp"

namespace rmac::fieldbus::canopen {

/// What a node told of who it is: 1000h and 1018h, which never change in a device. Whatever was asked, and however
/// often, two values of one of them come from two devices. Real-time safe.
class IdentityRecord {
 public:
  struct Contradiction {
    ObjectAddress object;
    std::uint32_t first = 0, second = 0;
  };
  /// An SDO answer of the node; what it says against an earlier one, which stays on record.
  [[nodiscard]] std::optional<Contradiction> take(const CanFrame& frame) noexcept;
  void forget() noexcept { told_ = {}; }
  /// 0 for what was not told.
  [[nodiscard]] Identity identity() const noexcept {
    return {told_[1].value_or(0), told_[2].value_or(0), told_[3].value_or(0), told_[4].value_or(0)};
  }

 private:
  std::array<std::optional<std::uint32_t>, 5> told_{};  ///< 1000h, and 1018h by its sub-index
};

}  // namespace rmac::fieldbus::canopen
