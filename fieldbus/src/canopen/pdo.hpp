#pragma once

#include <array>
#include <span>
#include <vector>

#include "rmac/fieldbus/can/can_port.hpp"
#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// Objects that carry a word of `DriveCommand`, and dummies: data types as entries, which fill room (CiA 301, 7.4.7).
inline constexpr std::array kSetpointWords{
    MappedObject{{0x6040, 0}, 16}, MappedObject{{0x6060, 0}, 8},  MappedObject{{0x6071, 0}, 16},
    MappedObject{{0x607A, 0}, 32}, MappedObject{{0x60FF, 0}, 32}, MappedObject{{0x60C1, 1}, 32},
    MappedObject{{0x60B1, 0}, 32}, MappedObject{{0x60B2, 0}, 16}, MappedObject{{0x60B8, 0}, 16},
    MappedObject{{0x0005, 0}, 8},  MappedObject{{0x0006, 0}, 16}, MappedObject{{0x0007, 0}, 32}};

/// Objects that carry a word of `DriveFeedback`.
inline constexpr std::array kAnswerWords{
    MappedObject{{0x6041, 0}, 16}, MappedObject{{0x603F, 0}, 16}, MappedObject{{0x6061, 0}, 8},
    MappedObject{{0x6064, 0}, 32}, MappedObject{{0x606C, 0}, 32}, MappedObject{{0x6077, 0}, 16},
    MappedObject{{0x60FD, 0}, 32}, MappedObject{{0x60B9, 0}, 16}, MappedObject{{0x60BA, 0}, 32},
    MappedObject{{0x60BB, 0}, 32}, MappedObject{{0x60BC, 0}, 32}, MappedObject{{0x60BD, 0}, 32}};

/// Fills an axis's RPDO from the words of a cycle. Real-time safe.
[[nodiscard]] CanFrame pack_setpoints(const AxisConfig& axis, const DriveCommand& command) noexcept;
/// And its second one, where it has one. Real-time safe.
[[nodiscard]] CanFrame pack_more_setpoints(const AxisConfig& axis, const DriveCommand& command) noexcept;

/// Adds the words of an axis that shares an RPDO: its bytes are dummies, zeros, in the frames of the others.
void add_setpoints(CanFrame& shared, const CanFrame& own) noexcept;

/// Takes the words of a TPDO of an axis. False, and nothing changes, when the frame is shorter than what is mapped.
/// Real-time safe.
[[nodiscard]] bool unpack_answers(const AxisConfig& axis, const std::vector<MappedObject>& contents,
                                  const CanFrame& frame, DriveFeedback& feedback) noexcept;

}  // namespace rmac::fieldbus::canopen
