#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string_view>

#include "rmac/fieldbus/eds/object_entry.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::eds {

/// What a maker says of a device in an electronic data sheet (EDS), and what a machine's builder made of it in a device
/// configuration file (DCF): CiA 306-1. The second is the first with values for one node.
struct DeviceDescription {
  std::string file;  ///< for messages
  std::string vendor_name;
  std::string product_name;
  std::uint32_t vendor_number = 0;        ///< 1018h:01; 0: not told
  std::uint32_t product_number = 0;       ///< 1018h:02; 0: not told
  std::set<std::uint32_t> bit_rates;      ///< bit/s that the device knows; empty: not told
  std::optional<std::uint8_t> node;       ///< of a DCF
  std::optional<std::uint32_t> bit_rate;  ///< bit/s, of a DCF
  std::map<ObjectAddress, ObjectEntry> entries;
  std::map<std::uint16_t, ObjectEntry> dummies;  ///< data types, mappable where they fill room in an RPDO

  [[nodiscard]] const ObjectEntry* find(ObjectAddress address) const;
  [[nodiscard]] bool has(std::uint16_t index) const;
  /// "drive.eds:12", for messages about an entry.
  [[nodiscard]] std::string place_of(const ObjectEntry& entry) const;
};

/// Reads the text of an EDS or DCF. Errors name `file`, the line, and what is allowed there.
[[nodiscard]] Expected<DeviceDescription> parse_device_description(std::string_view text, const std::string& file);

/// The same from a file.
[[nodiscard]] Expected<DeviceDescription> read_device_description(const std::filesystem::path& file);

}  // namespace rmac::fieldbus::eds
