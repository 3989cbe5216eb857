#pragma once

#include <string>
#include <vector>

#include "rmac/fieldbus/canopen/canopen_config.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::fieldbus::canopen {

/// The description that counts for a node before it told who it is: the one that `device.json` names, or the only one
/// of the vendor and product that it gives. Null where there is none.
[[nodiscard]] const DriveDescription* chosen_drive(const CanopenConfig& config, std::uint8_t node);

/// Which descriptions a node may turn out to have, null for none at all; the first counts until it told who it is.
[[nodiscard]] std::vector<const DriveDescription*> possible_drives(const CanopenConfig& config, std::uint8_t node);

/// What is wrong with the descriptions that `device.json` chooses; empty where nothing is.
[[nodiscard]] std::string check_chosen_drives(const CanopenConfig& config);

/// What is to be known of a node that is treated by a description.
[[nodiscard]] std::vector<std::string> remarks(const DriveDescription& drive, std::uint8_t node);

/// The statusword as the standard has it. `drive` may be null. Real-time safe.
[[nodiscard]] std::uint16_t status_by(const DriveDescription* drive, const DriveFeedback& told) noexcept;

}  // namespace rmac::fieldbus::canopen
