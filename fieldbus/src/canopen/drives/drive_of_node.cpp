#include "canopen/drives/drive_of_node.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr const char* kNone = "none";

/// The first axis of a node says who the node is.
const AxisConfig& first_axis(const CanopenConfig& config, std::uint8_t node) {
  return *std::find_if(config.axes.begin(), config.axes.end(),
                       [node](const AxisConfig& axis) { return axis.node == node; });
}

/// What device.json says of the node's description; empty: nothing.
std::string named_drive(const CanopenConfig& config, std::uint8_t node) {
  for (const AxisConfig& axis : config.axes) {
    if (axis.node == node && !axis.drive.empty()) return axis.drive;
  }
  return {};
}

}  // namespace

const DriveDescription* chosen_drive(const CanopenConfig& config, std::uint8_t node) {
  if (!config.drives) return nullptr;
  const std::string name = named_drive(config, node);
  if (name == kNone) return nullptr;
  if (!name.empty()) return config.drives->find_name(name);
  const Identity& given = first_axis(config, node).identity;
  if (given.product_code == 0) return nullptr;
  if (given.revision_number != 0) return config.drives->find(given);
  return config.drives->find_product(given.vendor_id, given.product_code);
}

std::vector<const DriveDescription*> possible_drives(const CanopenConfig& config, std::uint8_t node) {
  std::vector<const DriveDescription*> possible{chosen_drive(config, node)};
  if (!config.drives || !named_drive(config, node).empty()) return possible;
  if (possible.front() != nullptr) possible.push_back(nullptr);
  const Identity& given = first_axis(config, node).identity;
  const auto may_be = [](std::uint32_t known, std::uint32_t told) { return known == 0 || known == told; };
  for (const DriveDescription& drive : config.drives->drives) {
    if (&drive == possible.front()) continue;
    if (may_be(given.vendor_id, drive.vendor_id) && may_be(given.product_code, drive.product_code)) {
      possible.push_back(&drive);
    }
  }
  return possible;
}

std::string check_chosen_drives(const CanopenConfig& config) {
  for (const AxisConfig& axis : config.axes) {
    const DriveDescription* drive = chosen_drive(config, axis.node);
    if (drive != nullptr && !drive->refusal.empty()) return drive->refusal;
    const bool by_name = !axis.drive.empty() && axis.drive != kNone;
    if (by_name && (!config.drives || config.drives->find_name(axis.drive) == nullptr)) {
      return fmt::format(
          "drive is \"{}\" for node {}, and there is no such description; leave it out to have it found "
          "by the node's identity (1018h), or say \"none\"",
          axis.drive, axis.node);
    }
  }
  return {};
}

std::uint16_t status_by(const DriveDescription* drive, const DriveFeedback& told) noexcept {
  constexpr unsigned kNoQuickStop = 1U << 5U;
  constexpr unsigned kFault = 1U << 3U;
  unsigned word = told.statusword;
  if (drive == nullptr) return told.statusword;
  // In Fault and Switch on disabled the bit means nothing.
  if (drive->manners.quick_stop_inverted) word ^= kNoQuickStop;
  const bool homed = (word & (statusword::kHomingAttained | statusword::kHomingError)) != 0 && (word & kFault) == 0;
  if (drive->manners.homing_without_target_reached && told.mode == DriveMode::Homing && homed) {
    word |= statusword::kTargetReached;
  }
  return static_cast<std::uint16_t>(word);
}

std::vector<std::string> remarks(const DriveDescription& drive, std::uint8_t node) {
  std::vector<std::string> all{
      fmt::format("node {} is treated as {}, by {} (tried: {})", node, drive.name, drive.file, drive.tried)};
  if (!drive.manners.no_heartbeat_consumer.empty()) {
    all.push_back(fmt::format("node {} does not watch its master (it has no 1016h). When the master dies: {}", node,
                              drive.manners.no_heartbeat_consumer));
  }
  if (drive.manners.node_guarding) {
    all.push_back(
        fmt::format("node {} knows no heartbeat of its master (1016h): it is guarded, by remote frames", node));
  }
  if (drive.manners.no_abort_connection) {
    all.push_back(fmt::format(
        "node {} has no 6007h, and is not told to make a quick stop when its master dies; test what it does", node));
  }
  return all;
}

}  // namespace rmac::fieldbus::canopen
