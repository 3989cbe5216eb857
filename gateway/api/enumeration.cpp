#include "gateway/api/enumeration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rmac::gateway {

namespace {

using Value = Enumeration::Value;

constexpr std::array kJointTypes{Value{"DMAC_ROT_JNT", 0}, Value{"DMAC_LIN_JNT", 1}, Value{"DMAC_SCREW_JNT", 2}};
constexpr std::array kJointLimitTypes{Value{"DMAC_LIMITED_JNT", 0}, Value{"DMAC_INFINITY_JNT", 1},
                                      Value{"DMAC_INFINITY_JNT_POS", 2}, Value{"DMAC_INFINITY_JNT_NEG", 3}};
constexpr std::array kControlMethods{Value{"DMAC_POSITION_CONTROL", 0}, Value{"DMAC_VELOCITY_CONTROL", 1},
                                     Value{"DMAC_FORCE_CONTROL", 2}};
constexpr std::array kCycleModes{Value{"MANUAL", 0}, Value{"AUTOMATIC", 1}};
constexpr std::array kControlModes{Value{"MODE_INACTIVE", 0},       Value{"MODE_MANUAL", 1},
                                   Value{"MODE_AUTOMATIC_MOVE", 2}, Value{"MODE_AUTOMATIC_MEASURE", 3},
                                   Value{"MODE_STARTUP", 4},        Value{"MODE_SHUTDOWN", 5}};
constexpr std::array kParameterNumbers{Value{"MACH_PREHIT_DISTANCE", 0}, Value{"MACH_SEARCH_DISTANCE", 1},
                                       Value{"MACH_RETRACT_DISTANCE", 2}, Value{"MACH_SCAN_SPEED", 3}};
constexpr std::array kMajorCodes{Value{"MACHINE_SUCCESS", 0}, Value{"MACHINE_ERROR", 1}};
constexpr std::array kMinorCodes{Value{"NONE", 0},
                                 Value{"MACHINE_ERR_UNKNOWN", 1},
                                 Value{"MACHINE_ERR_EMERGENCY_STOP", 2},
                                 Value{"MACHINE_ERR_NO_AIR", 3},
                                 Value{"MACHINE_ERR_TRAVEL_LIMIT", 4},
                                 Value{"MACHINE_ERR_SPEED_LIMIT", 5},
                                 Value{"MACHINE_ERR_ACCELERATION_LIMIT", 6},
                                 Value{"MACHINE_ERR_PROBE_NOT_ARMED", 7},
                                 Value{"MACHINE_ERR_SCALE", 8},
                                 Value{"MACHINE_ERR_PART_NOT_FOUND", 9},
                                 Value{"MACHINE_ERR_UNEXPECTED_HIT", 10},
                                 Value{"MACHINE_ERR_COMM_TIMEOUT", 11},
                                 Value{"MACHINE_ERR_RESPONSE_TIMEOUT", 12},
                                 Value{"MACHINE_ERR_INVALID_PARAMETER", 13},
                                 Value{"MACHINE_ERR_INVALID_PARAMETER_VALUE", 14},
                                 Value{"MACHINE_ERR_COMMAND_QUEUE_FULL", 15},
                                 Value{"MACHINE_ERR_UNSUPPORTED_OPERATION", 16},
                                 Value{"MACHINE_ERR_OTHER", 17}};
constexpr std::array kRotationSigns{Value{"counter-clockwise about the arc's normal", 1}, Value{"clockwise", -1}};
constexpr std::array kRotaryDirections{Value{"shortest", 0}, Value{"positive", 1}, Value{"negative", -1}};

}  // namespace

const Enumeration kJointTypeValues{"JointType", kJointTypes};
const Enumeration kJointLimitTypeValues{"JointLimitType", kJointLimitTypes};
const Enumeration kControlMethodValues{"ServoControlMethod", kControlMethods};
const Enumeration kCycleModeValues{"CycleMode", kCycleModes};
const Enumeration kControlModeValues{"ControlMode", kControlModes};
const Enumeration kParameterNumberValues{"ParamNumber", kParameterNumbers};
const Enumeration kMajorCodeValues{"StatusMajorCode", kMajorCodes};
const Enumeration kMinorCodeValues{"StatusMinorCode", kMinorCodes};
const Enumeration kRotationSignValues{"RotSign", kRotationSigns};
const Enumeration kRotaryDirectionValues{"Direction", kRotaryDirections};

std::span<const Enumeration* const> enumerations() {
  static constexpr std::array kAll{&kJointTypeValues,      &kJointLimitTypeValues, &kControlMethodValues,
                                   &kCycleModeValues,      &kControlModeValues,    &kParameterNumberValues,
                                   &kMajorCodeValues,      &kMinorCodeValues,      &kRotationSignValues,
                                   &kRotaryDirectionValues};
  return kAll;
}

const Enumeration::Value* Enumeration::find(std::int64_t number) const noexcept {
  const auto found = std::ranges::find_if(values, [&](const Value& value) { return value.number == number; });
  return found == values.end() ? nullptr : &*found;
}

const Enumeration::Value* Enumeration::find(const std::string& value_name) const noexcept {
  const auto found = std::ranges::find_if(values, [&](const Value& value) { return value_name == value.name; });
  return found == values.end() ? nullptr : &*found;
}

std::string Enumeration::list() const {
  std::string text;
  for (const Value& value : values)
    text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", value.name, value.number);
  return text;
}

}  // namespace rmac::gateway
