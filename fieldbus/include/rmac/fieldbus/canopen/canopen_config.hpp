#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rmac/fieldbus/canopen/drive_library.hpp"
#include "rmac/fieldbus/canopen/sdo.hpp"
#include "rmac/fieldbus/eds/device_description.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus::canopen {

inline constexpr std::uint16_t kFirstProfileObject = 0x6000;
inline constexpr std::uint16_t kAxisOffset = 0x800;  ///< between the objects of two axes of a node (CiA 402-2, 5.2)
inline constexpr std::size_t kMostAxesPerNode = 4;   ///< as many as have identifiers in the predefined connection set

/// An entry of a PDO: an object of a node's first axis, and how long it is.
struct MappedObject {
  ObjectAddress object;
  std::uint8_t bits = 0;

  [[nodiscard]] bool operator==(const MappedObject&) const = default;
};

/// What is to be written to a node when it is brought up.
struct SdoWrite {
  ObjectAddress object;
  std::vector<std::uint8_t> bytes;
};

/// One axis of the bus: a CiA 402 drive, or one axis of a drive for several.
struct AxisConfig {
  std::uint8_t node = 0;
  std::uint8_t axis_in_node = 0;
  std::uint8_t rpdo_node = 0;  ///< whose RPDO's identifier it listens to, sharing it by dummies; 0: its own
  DriveMode mode = DriveMode::CyclicSyncTorque;
  std::vector<MappedObject> setpoints;       ///< the RPDO
  std::vector<MappedObject> more_setpoints;  ///< the second RPDO; empty: there is none
  std::vector<MappedObject> answers;         ///< the TPDO
  std::vector<MappedObject> more_answers;    ///< the second TPDO; empty: there is none
  std::optional<MappedObject> sensor;        ///< one of the answers, a sensor's reading with a sign
  double velocity_units_per_rpm = 1;         ///< of 60FFh, 60B1h and 606Ch
  Identity identity;
  std::string drive;                                     ///< its description's name, "none"; empty: by its identity
  std::optional<std::chrono::milliseconds> sdo_timeout;  ///< for each of its SDO answers, where it is given
  std::optional<int> answer_delay;                       ///< cycles, where it is given: `DriveManners::answer_delay`
  std::vector<SdoWrite> setup;
  bool sets_polarity = false;                                 ///< 607Eh is among `setup`
  bool check_scale = true;                                    ///< its factors are asked of it at boot
  bool homes = false;                                         ///< it can be told to home: mode 6 is asked of it, too
  std::shared_ptr<const eds::DeviceDescription> description;  ///< null where no file was named
};

/// Where SYNC stands among the frames of a cycle: behind the setpoints or before them, or nowhere, because another node
/// produces it.
enum class SyncOrder : std::uint8_t { Last, First, External };

/// One CANopen bus and its drives.
struct CanopenConfig {
  std::string interface;  ///< "can0"
  std::vector<AxisConfig> axes;
  std::chrono::nanoseconds period = std::chrono::milliseconds(1);
  std::uint32_t bit_rate = 1'000'000;
  double load_share = 0.8;  ///< of a cycle that SYNC and PDOs may fill
  std::chrono::milliseconds heartbeat{50};
  std::chrono::nanoseconds time_interval{0};  ///< between two TIME messages; 0: none
  std::uint8_t master_node = 127;
  std::optional<std::chrono::milliseconds> boot_timeout;  ///< where it is given
  std::optional<int> abort_connection;                    ///< 6007h, where it is given; -1: not written
  std::uint32_t missed_answers = 1;                       ///< SYNCs in a row that a drive may leave unanswered
  SyncOrder sync = SyncOrder::Last;
  std::shared_ptr<const DriveLibrary> drives;  ///< null: none is known

  /// How long a heartbeat may be absent before its producer counts as gone.
  [[nodiscard]] std::chrono::milliseconds heartbeat_deadline() const noexcept { return heartbeat * 3 / 2; }
};

/// Finds and reads the EDS or DCF of a name in `device.json`; `kind` is "eds" or "dcf".
using FindDescription =
    std::function<Expected<eds::DeviceDescription>(const std::string& kind, const std::string& name)>;

/// Reads the parameters of `CANopenInterface` in `device.json` (docs/canopen.md). A parameter named `bus.name` is for
/// the bus `bus` alone and wins over `name`. The bus's name is the CAN interface's. The error names the parameter,
/// its value and what is allowed. Drives that name an EDS or DCF are held against it. `drives`: those that are known.
[[nodiscard]] Expected<CanopenConfig> read_canopen_config(const std::string& bus,
                                                          const std::map<std::string, std::vector<double>>& numbers,
                                                          const std::map<std::string, std::string>& texts,
                                                          double period_s, const FindDescription& find = {},
                                                          std::shared_ptr<const DriveLibrary> drives = {});

/// COB-IDs of an axis: the predefined connection set (CiA 301, 7.3.5), one pair for each axis of a node. Axes that
/// share an RPDO have the same identifier of setpoints.
[[nodiscard]] inline std::uint16_t setpoint_id(const AxisConfig& axis) noexcept {
  return static_cast<std::uint16_t>(0x200 + 0x100 * axis.axis_in_node +
                                    (axis.rpdo_node != 0 ? axis.rpdo_node : axis.node));
}
[[nodiscard]] inline std::uint16_t answer_id(const AxisConfig& axis) noexcept {
  return static_cast<std::uint16_t>(0x180 + 0x100 * axis.axis_in_node + axis.node);
}
/// The second RPDO's and TPDO's identifiers, which are those of a second axis: only a drive of one axis can have them.
[[nodiscard]] inline std::uint16_t more_setpoints_id(const AxisConfig& axis) noexcept {
  return static_cast<std::uint16_t>(0x300 + axis.node);
}
[[nodiscard]] inline std::uint16_t more_answers_id(const AxisConfig& axis) noexcept {
  return static_cast<std::uint16_t>(0x280 + axis.node);
}

/// How long a node's answers may take.
struct Patience {
  std::chrono::milliseconds sdo_timeout{500};  ///< for each answer
  int sdo_tries = 3;                           ///< of a question: a frame may be lost, or a node has no time just then
  std::chrono::milliseconds boot_timeout{5000};
};
/// By `device.json` (the slowest of a node's axes), by the drive's description, which may be null, or by default.
[[nodiscard]] Patience patience_with(const CanopenConfig& config, std::uint8_t node, const DriveDescription* drive);

/// Bytes of a PDO.
[[nodiscard]] std::size_t mapped_bytes(const std::vector<MappedObject>& objects) noexcept;

}  // namespace rmac::fieldbus::canopen
