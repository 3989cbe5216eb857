#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/eds/object_entry.hpp"
#include "rmac/motion/error.hpp"

namespace rmac::fieldbus::canopen {

/// Who a node is (1018h). 0: whoever it is.
struct Identity {
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t revision_number = 0;
  std::uint32_t serial_number = 0;
};

/// An object that is left alone, or all of its sub-indices.
struct SkippedObject {
  std::uint16_t index = 0;
  std::optional<std::uint8_t> sub;

  [[nodiscard]] bool operator==(const SkippedObject&) const = default;
};

/// What a drive takes in 60C2h.
struct InterpolationTimes {
  int index = 0;                     ///< 60C2h:02, a power of ten of a second
  std::vector<std::uint8_t> values;  ///< of 60C2h:01; empty: all from 1 on
};

/// Where a make of drives departs from what the master takes for granted. What `device.json` gives goes before it.
struct DriveManners {
  std::vector<SkippedObject> skip{};                       ///< of a node's first axis; neither read nor written
  std::optional<std::chrono::milliseconds> sdo_timeout{};  ///< for each answer
  std::optional<int> sdo_retries{};                        ///< of a question without an answer
  std::optional<std::chrono::milliseconds> boot_timeout{};
  bool fixed_mapping = false;        ///< its PDOs' contents are compared, and not written
  bool store_after_mapping = false;  ///< they count from the reset on that follows their storing (1010h)
  bool no_abort_connection = false;  ///< it has no 6007h
  std::string
      no_heartbeat_consumer{};       ///< it has no 1016h, and this is what it does when the master dies; empty: it has
  bool node_guarding = false;        ///< it knows no heartbeat, and is asked for its state instead (100Ch, 100Dh)
  bool quick_stop_inverted = false;  ///< bit 5 of its statusword is 0 where the standard has 1
  bool homing_without_target_reached = false;  ///< bit 10 of its statusword does not tell that it is at rest at home
  int answer_delay = 1;  ///< it was where its answers say so many cycles before they are read; 1: it measures at SYNC
  std::optional<InterpolationTimes> interpolation{};  ///< none: whatever the standard allows
};

/// A file of the library of drives.
struct DriveDescription {
  std::string file;
  std::string name;
  std::string tried;  ///< on what its values were tried
  std::uint32_t vendor_id = 0;
  std::uint32_t product_code = 0;
  std::uint32_t first_revision = 0;
  std::uint32_t last_revision = 0xFFFFFFFF;
  DriveManners manners;
  std::string refusal;  ///< why a drive that it is for is not taken; empty: the file is sound

  [[nodiscard]] bool covers(const Identity& told) const noexcept {
    return vendor_id == told.vendor_id && product_code == told.product_code && first_revision <= told.revision_number &&
           told.revision_number <= last_revision;
  }
};

/// The drives that are known.
struct DriveLibrary {
  std::vector<DriveDescription> drives;
  std::vector<std::string> unreadable;  ///< files of which not even the identity could be read, and why

  /// The description of a node that told who it is; null where there is none.
  [[nodiscard]] const DriveDescription* find(const Identity& told) const noexcept;
  /// The only one for a make and product, whatever the revision; null where there is none, or several.
  [[nodiscard]] const DriveDescription* find_product(std::uint32_t vendor_id,
                                                     std::uint32_t product_code) const noexcept;
  /// By its file's name without folder and ending; null where there is none.
  [[nodiscard]] const DriveDescription* find_name(const std::string& name) const;
  /// Refuses each file that another one is for the same drives as; both are named.
  void refuse_doubles();
};

/// Whether a description could be followed as a whole; the error names the key.
[[nodiscard]] Expected<> check(const DriveManners& manners);

}  // namespace rmac::fieldbus::canopen
