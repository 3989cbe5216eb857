#pragma once

#include <functional>
#include <map>
#include <optional>

#include "gateway/simulators/vdrive/objects/sdo_server.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"

namespace rmac::vdrive {

/// Abort code: a value that the object does not take (CiA 301, 7.2.4.3.17, table 22).
inline constexpr std::uint32_t kBadValue = 0x06090030;

/// The object dictionary of a node, made from its data sheet: types, access, limits and initial values are the file's,
/// so that the file cannot say another thing than the device does.
class Dictionary final : public SdoObjects {
 public:
  /// Refuses a write with an abort code, before it takes effect; 0 lets it pass.
  using Check = std::function<std::uint32_t(ObjectAddress, std::int64_t)>;
  using Notice = std::function<void(ObjectAddress)>;

  /// `serial_number` in the place of the file's (1018h:04), where there is one.
  Dictionary(const fieldbus::eds::DeviceDescription& sheet, std::uint8_t node,
             std::optional<std::uint32_t> serial_number = std::nullopt);

  Check before_write;
  Notice after_write;  ///< by SDO or PDO
  Notice before_read;  ///< by SDO: the place to refresh what the process tells

  [[nodiscard]] std::uint32_t read(ObjectAddress object, Bytes& bytes) override;
  [[nodiscard]] std::uint32_t write(ObjectAddress object, const Bytes& bytes) override;

  /// For the node's own use. An object that the sheet lacks is 0, and setting it does nothing.
  [[nodiscard]] std::int64_t number(std::uint16_t index, std::uint8_t sub = 0) const noexcept;
  void set(std::uint16_t index, std::int64_t value) noexcept { set({index, 0}, value); }
  void set(ObjectAddress object, std::int64_t value) noexcept;

  /// Abort code that refuses to map an object of `bits`, or 0. Dummies are mapped as setpoints only (CiA 301, 7.4.7).
  [[nodiscard]] std::uint32_t check_mapping(std::uint32_t entry, bool setpoint) const;
  [[nodiscard]] const Bytes* bytes(ObjectAddress object) const;
  /// A PDO's write: as long as the object is, checked when it was mapped.
  void take(ObjectAddress object, const std::uint8_t* bytes);

  /// What a reset gives: the values that were stored last, else those of the sheet. `communication` is 1000h to 1FFFh.
  void restore(bool communication_only);
  void store();
  /// From the next reset the sheet's values count again.
  void forget() { stored_.clear(); }

 private:
  struct Slot {
    fieldbus::eds::DataType type;
    fieldbus::eds::Access access;
    bool mappable;
    std::optional<std::int64_t> least, most;
    Bytes initial;
    Bytes bytes;
  };
  [[nodiscard]] std::uint32_t absent(ObjectAddress object) const;

  std::map<ObjectAddress, Slot> slots_;
  std::map<ObjectAddress, Bytes> stored_;
};

}  // namespace rmac::vdrive
