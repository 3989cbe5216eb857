#include "canopen/pdo.hpp"

#include <algorithm>
#include <cmath>

namespace rmac::fieldbus::canopen {
namespace {

/// Rounded, and bounded to what the word holds.
std::int32_t to_long(double value) noexcept {
  return static_cast<std::int32_t>(std::lround(std::clamp(value, -2147483648.0, 2147483647.0)));
}

std::uint32_t setpoint_word(const AxisConfig& axis, const DriveCommand& command, std::uint16_t index) noexcept {
  switch (index) {
    case 0x6040:
      return command.controlword;
    case 0x6060:
      return static_cast<std::uint32_t>(command.mode);
    case 0x6071:
      return static_cast<std::uint32_t>(command.target_torque_permille);
    case 0x607A:
    case 0x60C1:
      return static_cast<std::uint32_t>(command.target_position_counts);
    case 0x60FF:
      return static_cast<std::uint32_t>(to_long(command.target_velocity_rpm * axis.velocity_units_per_rpm));
    case 0x60B1:
      return static_cast<std::uint32_t>(to_long(command.velocity_offset_rpm * axis.velocity_units_per_rpm));
    case 0x60B2:
      return static_cast<std::uint32_t>(command.torque_offset_permille);
    case 0x60B8:
      return command.touch_probe;
    default:
      return 0;
  }
}

void take_word(const AxisConfig& axis, std::uint16_t index, std::uint32_t word, DriveFeedback& feedback) noexcept {
  switch (index) {
    case 0x6041:
      feedback.statusword = static_cast<std::uint16_t>(word);
      break;
    case 0x603F:
      feedback.error_code = static_cast<std::uint16_t>(word);
      break;
    case 0x6061:
      feedback.mode = static_cast<DriveMode>(static_cast<std::int8_t>(word));
      break;
    case 0x6064:
      feedback.position_counts = static_cast<std::int32_t>(word);
      break;
    case 0x606C:
      feedback.velocity_rpm = to_long(static_cast<std::int32_t>(word) / axis.velocity_units_per_rpm);
      break;
    case 0x6077:
      feedback.torque_permille = static_cast<std::int16_t>(word);
      break;
    case 0x60FD:
      feedback.inputs = word;
      break;
    case 0x60B9:
      feedback.touch_probe = static_cast<std::uint16_t>(word);
      break;
    case 0x60BA:
    case 0x60BB:
    case 0x60BC:
    case 0x60BD:
      feedback.latched_counts[index - 0x60BAU] = static_cast<std::int32_t>(word);
      break;
    default:
      break;
  }
}

CanFrame pack(const AxisConfig& axis, std::uint16_t id, const std::vector<MappedObject>& contents,
              const DriveCommand& command) noexcept {
  CanFrame frame;
  frame.id = id;
  for (const MappedObject& mapped : contents) {
    const std::uint32_t word = setpoint_word(axis, command, mapped.object.index);
    for (unsigned bit = 0; bit < mapped.bits; bit += 8)
      frame.data[frame.size++] = static_cast<std::uint8_t>(word >> bit);
  }
  return frame;
}

}  // namespace

CanFrame pack_setpoints(const AxisConfig& axis, const DriveCommand& command) noexcept {
  return pack(axis, setpoint_id(axis), axis.setpoints, command);
}

CanFrame pack_more_setpoints(const AxisConfig& axis, const DriveCommand& command) noexcept {
  return pack(axis, more_setpoints_id(axis), axis.more_setpoints, command);
}

void add_setpoints(CanFrame& shared, const CanFrame& own) noexcept {
  for (std::size_t i = 0; i < own.size; ++i) shared.data[i] = static_cast<std::uint8_t>(shared.data[i] | own.data[i]);
}

bool unpack_answers(const AxisConfig& axis, const std::vector<MappedObject>& contents, const CanFrame& frame,
                    DriveFeedback& feedback) noexcept {
  if (frame.size < mapped_bytes(contents)) return false;
  std::size_t at = 0;
  for (const MappedObject& mapped : contents) {
    std::uint32_t word = 0;
    for (unsigned bit = 0; bit < mapped.bits; bit += 8) word |= static_cast<std::uint32_t>(frame.data[at++]) << bit;
    take_word(axis, mapped.object.index, word, feedback);
    if (axis.sensor == mapped) {
      const std::uint32_t sign = std::uint32_t{1} << ((mapped.bits - 1U) & 31U);
      feedback.sensor_counts = static_cast<std::int32_t>((word ^ sign) - sign);
      feedback.sensor_valid = true;
    }
  }
  return true;
}

}  // namespace rmac::fieldbus::canopen
