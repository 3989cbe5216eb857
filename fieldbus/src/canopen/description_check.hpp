#pragma once

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// What a DCF has its node told at boot, in the order of the objects. Communication objects (1000h to 1FFFh) are the
/// master's own to write, except for 1029h (error behavior); setpoints belong to the cycle.
[[nodiscard]] std::vector<SdoWrite> configured_writes(const eds::DeviceDescription& description, std::uint8_t node);

/// The contents that a DCF gives the PDO of an axis, as `read_mapping` takes them; empty where it gives none.
/// `mapping_index` is that of the node's first axis: 1600h or 1A00h.
[[nodiscard]] std::string configured_mapping(const eds::DeviceDescription& description, std::uint16_t mapping_index,
                                             std::uint8_t axis_in_node);

/// Holds what a drive will be told at boot against the EDS or DCF that `axis` names, if it does: mapped objects exist,
/// can be mapped that way and have that length; written ones exist, can be written, have that length, and the values
/// are within the limits; node and bit rate are the file's. The error names the file and the line.
[[nodiscard]] Expected<> check_description(const CanopenConfig& config, const AxisConfig& axis);

}  // namespace rmac::fieldbus::canopen
