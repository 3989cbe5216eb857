#include "canopen/objects/standard_objects.hpp"

#include <algorithm>
#include <array>

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using enum eds::DataType;

constexpr bool kPattern = true;

/// Units of position, velocity and acceleration are the user's own (CiA 402-2, 8.3), set by 60A8h and the like.
constexpr const char* kPosition = "position units";
constexpr const char* kVelocity = "velocity units";
constexpr const char* kAcceleration = "acceleration units";
constexpr const char* kTorque = "\u2030 of rated torque";

// In the order of their addresses.
constexpr std::array kObjects{
    StandardObject{{0x1000, 0}, "Device type", Unsigned32, "", kPattern},
    StandardObject{{0x1001, 0}, "Error register", Unsigned8, "", kPattern},
    StandardObject{{0x1002, 0}, "Manufacturer status register", Unsigned32, "", kPattern},
    StandardObject{{0x1003, 0}, "Number of errors", Unsigned8},
    StandardObject{{0x1005, 0}, "COB-ID SYNC", Unsigned32, "", kPattern},
    StandardObject{{0x1006, 0}, "Communication cycle period", Unsigned32, "\u00b5s"},
    StandardObject{{0x1007, 0}, "Synchronous window length", Unsigned32, "\u00b5s"},
    StandardObject{{0x1008, 0}, "Manufacturer device name", VisibleString},
    StandardObject{{0x1009, 0}, "Manufacturer hardware version", VisibleString},
    StandardObject{{0x100A, 0}, "Manufacturer software version", VisibleString},
    StandardObject{{0x100C, 0}, "Guard time", Unsigned16, "ms"},
    StandardObject{{0x100D, 0}, "Life time factor", Unsigned8},
    StandardObject{{0x1010, 1}, "Save all parameters", Unsigned32, "", kPattern},
    StandardObject{{0x1011, 1}, "Restore all default parameters", Unsigned32, "", kPattern},
    StandardObject{{0x1012, 0}, "COB-ID TIME", Unsigned32, "", kPattern},
    StandardObject{{0x1014, 0}, "COB-ID EMCY", Unsigned32, "", kPattern},
    StandardObject{{0x1015, 0}, "Inhibit time EMCY", Unsigned16, "100 \u00b5s"},
    StandardObject{{0x1016, 1}, "Consumer heartbeat time", Unsigned32, "", kPattern},
    StandardObject{{0x1017, 0}, "Producer heartbeat time", Unsigned16, "ms"},
    StandardObject{{0x1018, 1}, "Vendor-ID", Unsigned32, "", kPattern},
    StandardObject{{0x1018, 2}, "Product code", Unsigned32, "", kPattern},
    StandardObject{{0x1018, 3}, "Revision number", Unsigned32, "", kPattern},
    StandardObject{{0x1018, 4}, "Serial number", Unsigned32, "", kPattern},
    StandardObject{{0x1019, 0}, "Synchronous counter overflow value", Unsigned8},
    StandardObject{{0x1029, 1}, "Communication error behavior", Unsigned8},
    StandardObject{{0x6007, 0}, "Abort connection option code", Integer16},
    StandardObject{{0x603F, 0}, "Error code", Unsigned16, "", kPattern},
    StandardObject{{0x6040, 0}, "Controlword", Unsigned16, "", kPattern},
    StandardObject{{0x6041, 0}, "Statusword", Unsigned16, "", kPattern},
    StandardObject{{0x605A, 0}, "Quick stop option code", Integer16},
    StandardObject{{0x605B, 0}, "Shutdown option code", Integer16},
    StandardObject{{0x605C, 0}, "Disable operation option code", Integer16},
    StandardObject{{0x605D, 0}, "Halt option code", Integer16},
    StandardObject{{0x605E, 0}, "Fault reaction option code", Integer16},
    StandardObject{{0x6060, 0}, "Modes of operation", Integer8},
    StandardObject{{0x6061, 0}, "Modes of operation display", Integer8},
    StandardObject{{0x6062, 0}, "Position demand value", Integer32, kPosition},
    StandardObject{{0x6063, 0}, "Position actual internal value", Integer32, "increments"},
    StandardObject{{0x6064, 0}, "Position actual value", Integer32, kPosition},
    StandardObject{{0x6065, 0}, "Following error window", Unsigned32, kPosition},
    StandardObject{{0x6066, 0}, "Following error time out", Unsigned16, "ms"},
    StandardObject{{0x6067, 0}, "Position window", Unsigned32, kPosition},
    StandardObject{{0x6068, 0}, "Position window time", Unsigned16, "ms"},
    StandardObject{{0x606B, 0}, "Velocity demand value", Integer32, kVelocity},
    StandardObject{{0x606C, 0}, "Velocity actual value", Integer32, kVelocity},
    StandardObject{{0x6071, 0}, "Target torque", Integer16, kTorque},
    StandardObject{{0x6072, 0}, "Max torque", Unsigned16, kTorque},
    StandardObject{{0x6073, 0}, "Max current", Unsigned16, "\u2030 of rated current"},
    StandardObject{{0x6074, 0}, "Torque demand", Integer16, kTorque},
    StandardObject{{0x6075, 0}, "Motor rated current", Unsigned32, "mA"},
    StandardObject{{0x6076, 0}, "Motor rated torque", Unsigned32, "mN\u00b7m"},
    StandardObject{{0x6077, 0}, "Torque actual value", Integer16, kTorque},
    StandardObject{{0x6078, 0}, "Current actual value", Integer16, "\u2030 of rated current"},
    StandardObject{{0x6079, 0}, "DC link circuit voltage", Unsigned32, "mV"},
    StandardObject{{0x607A, 0}, "Target position", Integer32, kPosition},
    StandardObject{{0x607C, 0}, "Home offset", Integer32, kPosition},
    StandardObject{{0x607D, 1}, "Min position limit", Integer32, kPosition},
    StandardObject{{0x607D, 2}, "Max position limit", Integer32, kPosition},
    StandardObject{{0x607E, 0}, "Polarity", Unsigned8, "", kPattern},
    StandardObject{{0x607F, 0}, "Max profile velocity", Unsigned32, kVelocity},
    StandardObject{{0x6080, 0}, "Max motor speed", Unsigned32, "1/min"},
    StandardObject{{0x6081, 0}, "Profile velocity", Unsigned32, kVelocity},
    StandardObject{{0x6083, 0}, "Profile acceleration", Unsigned32, kAcceleration},
    StandardObject{{0x6084, 0}, "Profile deceleration", Unsigned32, kAcceleration},
    StandardObject{{0x6085, 0}, "Quick stop deceleration", Unsigned32, kAcceleration},
    StandardObject{{0x6086, 0}, "Motion profile type", Integer16},
    StandardObject{{0x6087, 0}, "Torque slope", Unsigned32, "\u2030 of rated torque per s"},
    StandardObject{{0x608F, 1}, "Encoder increments", Unsigned32},
    StandardObject{{0x608F, 2}, "Motor revolutions", Unsigned32},
    StandardObject{{0x6091, 1}, "Gear: motor revolutions", Unsigned32},
    StandardObject{{0x6091, 2}, "Gear: shaft revolutions", Unsigned32},
    StandardObject{{0x6092, 1}, "Feed", Unsigned32},
    StandardObject{{0x6092, 2}, "Feed: shaft revolutions", Unsigned32},
    StandardObject{{0x6098, 0}, "Homing method", Integer8},
    StandardObject{{0x6099, 1}, "Speed during search for switch", Unsigned32, kVelocity},
    StandardObject{{0x6099, 2}, "Speed during search for zero", Unsigned32, kVelocity},
    StandardObject{{0x609A, 0}, "Homing acceleration", Unsigned32, kAcceleration},
    StandardObject{{0x60B0, 0}, "Position offset", Integer32, kPosition},
    StandardObject{{0x60B1, 0}, "Velocity offset", Integer32, kVelocity},
    StandardObject{{0x60B2, 0}, "Torque offset", Integer16, kTorque},
    StandardObject{{0x60B8, 0}, "Touch probe function", Unsigned16, "", kPattern},
    StandardObject{{0x60B9, 0}, "Touch probe status", Unsigned16, "", kPattern},
    StandardObject{{0x60BA, 0}, "Touch probe 1 positive edge", Integer32, kPosition},
    StandardObject{{0x60BB, 0}, "Touch probe 1 negative edge", Integer32, kPosition},
    StandardObject{{0x60BC, 0}, "Touch probe 2 positive edge", Integer32, kPosition},
    StandardObject{{0x60BD, 0}, "Touch probe 2 negative edge", Integer32, kPosition},
    StandardObject{{0x60C1, 1}, "Interpolation data record 1", Integer32, kPosition},
    StandardObject{{0x60C2, 1}, "Interpolation time period value", Unsigned8},
    StandardObject{{0x60C2, 2}, "Interpolation time index", Integer8},
    StandardObject{{0x60F4, 0}, "Following error actual value", Integer32, kPosition},
    StandardObject{{0x60FD, 0}, "Digital inputs", Unsigned32, "", kPattern},
    StandardObject{{0x60FE, 1}, "Physical outputs", Unsigned32, "", kPattern},
    StandardObject{{0x60FF, 0}, "Target velocity", Integer32, kVelocity},
    StandardObject{{0x6502, 0}, "Supported drive modes", Unsigned32, "", kPattern},
};
static_assert(std::is_sorted(kObjects.begin(), kObjects.end(),
                             [](const auto& a, const auto& b) { return a.object < b.object; }));

/// Modes of operation by their numbers (CiA 402-2, 6060h).
constexpr std::array kModeNames{"",
                                "profile position",
                                "velocity",
                                "profile velocity",
                                "profile torque",
                                "",
                                "homing",
                                "interpolated position",
                                "cyclic synchronous position",
                                "cyclic synchronous velocity",
                                "cyclic synchronous torque"};
static_assert(kModeNames.size() == kMostMode + 1);

}  // namespace

ObjectAddress of_first_axis(ObjectAddress object) noexcept {
  constexpr auto kBeyond = kFirstProfileObject + kMostAxesPerNode * kAxisOffset;
  if (object.index < kFirstProfileObject || object.index >= kBeyond) return object;
  const auto within = static_cast<std::uint16_t>((object.index - kFirstProfileObject) % kAxisOffset);
  return {static_cast<std::uint16_t>(kFirstProfileObject + within), object.sub};
}

const StandardObject* find_standard_object(ObjectAddress object) noexcept {
  const ObjectAddress first = of_first_axis(object);
  const auto* const found =
      std::lower_bound(kObjects.begin(), kObjects.end(), first,
                       [](const StandardObject& known, ObjectAddress wanted) { return known.object < wanted; });
  return found != kObjects.end() && found->object == first ? &*found : nullptr;
}

const char* mode_name(std::int64_t mode) noexcept {
  return mode < 0 || mode > kMostMode ? "" : kModeNames.at(static_cast<std::size_t>(mode));
}

}  // namespace rmac::fieldbus::canopen
