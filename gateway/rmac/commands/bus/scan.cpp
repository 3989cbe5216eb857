#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gateway/buses/drive_library_file.hpp"
#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/commands/bus/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "rmac/fieldbus/can/socket_can_port.hpp"
#include "rmac/fieldbus/canopen/bus_scan.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;
using fieldbus::canopen::DriveDescription;
using fieldbus::canopen::DriveLibrary;
using fieldbus::canopen::ScannedNode;
using fieldbus::eds::DeviceDescription;

/// Data sheets of a folder. One that cannot be read is told, and does not keep the others from being used.
Result<std::vector<DeviceDescription>> read_sheets(const std::string& folder) {
  std::vector<DeviceDescription> sheets;
  if (folder.empty()) return sheets;
  std::error_code error;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    std::string extension = entry.path().extension();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return std::tolower(c); });
    if (extension == ".eds" || extension == ".dcf") files.push_back(entry.path());
  }
  if (error) return fail(fmt::format("{}: {}", folder, error.message()));
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    auto read = fieldbus::eds::read_device_description(file);
    if (read) {
      sheets.push_back(std::move(*read));
    } else {
      fmt::print(stderr, "rmac: {}\n", read.error().message);
    }
  }
  return sheets;
}

std::string state_text(const ScannedNode& node) {
  return node.state ? to_text(*node.state) : "no heartbeat";
}

std::vector<std::string> files_of(const ScannedNode& node, const std::vector<DeviceDescription>& sheets) {
  std::vector<std::string> files;
  for (const DeviceDescription& sheet : sheets) {
    if (describes(sheet, node)) files.push_back(fs::path(sheet.file).filename());
  }
  return files;
}

/// What is known of the makes of nodes.
struct Known {
  std::vector<DeviceDescription> sheets;
  DriveLibrary drives;
};

/// By which description a node would be treated; null: by none.
const DriveDescription* drive_of(const ScannedNode& node, const Known& known) {
  return node.answers ? known.drives.find(node.identity) : nullptr;
}

nlohmann::json node_json(const ScannedNode& node, const Known& known) {
  nlohmann::json entry{{"node", node.node},
                       {"state", state_text(node)},
                       {"answers", node.answers},
                       {"two_identities", node.two_identities},
                       {"answers_twice", node.answers_twice}};
  if (node.answers) {
    entry["device_type"] = node.device_type;
    entry["device"] = fieldbus::canopen::device_type_text(node.device_type);
    entry["vendor_id"] = node.identity.vendor_id;
    entry["product_code"] = node.identity.product_code;
    entry["revision_number"] = node.identity.revision_number;
    entry["serial_number"] = node.identity.serial_number;
    entry["name"] = node.name;
    entry["files"] = files_of(node, known.sheets);
    const DriveDescription* drive = drive_of(node, known);
    entry["drive"] = drive != nullptr ? nlohmann::json(drive->file) : nlohmann::json();
  }
  return entry;
}

std::vector<std::string> node_row(const ScannedNode& node, const Known& known) {
  const auto hexadecimal = [](std::uint32_t number) { return fmt::format("{:X}h", number); };
  if (!node.answers) return {std::to_string(node.node), state_text(node), "answers no SDO", "", "", "", "", "", "", ""};
  const DriveDescription* drive = drive_of(node, known);
  std::string files;
  for (const std::string& file : files_of(node, known.sheets)) files += (files.empty() ? "" : ", ") + file;
  return {std::to_string(node.node),
          state_text(node),
          fieldbus::canopen::device_type_text(node.device_type),
          hexadecimal(node.identity.vendor_id),
          hexadecimal(node.identity.product_code),
          hexadecimal(node.identity.revision_number),
          hexadecimal(node.identity.serial_number),
          node.name,
          files,
          drive != nullptr ? fs::path(drive->file).stem().string() : ""};
}

/// What a row cannot say; empty where nothing is wrong.
std::string warning(const ScannedNode& node, const Known& known) {
  if (const DriveDescription* drive = drive_of(node, known); drive != nullptr && !drive->refusal.empty()) {
    return fmt::format("node {}: a machine with it is refused: {}\n", node.node, drive->refusal);
  }
  if (node.two_identities) {
    return fmt::format("node {}: two devices have this id, and a machine with it is refused; give each its own\n",
                       node.node);
  }
  if (!node.answers_twice) return {};
  return fmt::format(
      "node {}: each question was answered twice: two devices have this id, or a gateway repeats frames\n", node.node);
}

struct ScanOptions {
  std::string interface;
  std::string folder;            ///< of data sheets; empty: none
  std::filesystem::path drives;  ///< descriptions of drives; empty: the installation's
};

Result<> scan_bus(const ScanOptions& options, bool json) {
  const std::string& interface = options.interface;
  auto sheets = read_sheets(options.folder);
  if (!sheets) return tl::unexpected(sheets.error());
  const Known known{
      std::move(*sheets),
      gateway::read_drive_library(options.drives.empty() ? gateway::default_folders().drives : options.drives)};
  for (const std::string& unreadable : known.drives.unreadable) fmt::print(stderr, "rmac: {}\n", unreadable);
  constexpr std::size_t kBurst = 4;
  auto port = fieldbus::SocketCanPort::open(interface, {}, kBurst);
  if (!port) return fail(port.error().message);
  const auto nodes = fieldbus::canopen::scan_bus(**port);
  if (!nodes) return fail(fmt::format("{}: {}", interface, nodes.error().message));
  if (json) {
    nlohmann::json list = nlohmann::json::array();
    for (const ScannedNode& node : *nodes) list.push_back(node_json(node, known));
    fmt::print("{}\n", list.dump());
    return {};
  }
  if (nodes->empty()) {
    return fail(
        fmt::format("{}: no node answers; check power, cable, termination, and that the drives' bit rate is the "
                    "interface's",
                    interface));
  }
  std::vector<std::vector<std::string>> rows;
  for (const ScannedNode& node : *nodes) rows.push_back(node_row(node, known));
  fmt::print(
      "{}",
      table({"node", "state", "device", "vendor", "product", "revision", "serial", "name", "file", "drive"}, rows));
  for (const ScannedNode& node : *nodes) fmt::print("{}", warning(node, known));
  return {};
}

}  // namespace

void add_bus_scan(Command& bus) {
  const auto options = std::make_shared<ScanOptions>();
  Command scan = bus.add("scan", "list the CANopen nodes on an interface; refuses a bus on which a machine runs");
  scan.option("INTERFACE", &options->interface, kInterfaceMeaning).required();
  scan.option("--eds", &options->folder, "a folder of EDS and DCF files: say which are the nodes'").existing_folder();
  scan.option("--drives", &options->drives, kDrivesMeaning).existing_folder();
  scan.does(without_appliance([options](bool json) { return scan_bus(*options, json); }));
}

}  // namespace rmac::cli
