#include "rmac/fieldbus/canopen/canopen_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "canopen/description_check.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "canopen/object_list.hpp"
#include "parameters.hpp"

namespace rmac::fieldbus::canopen {
namespace {

// What the setpoints and answers of a mode need (CiA 402-2, 14 to 17 and 10).
const char* default_setpoints(DriveMode mode, bool homes) {
  switch (mode) {
    case DriveMode::CyclicSyncTorque:
      return homes ? "6040:00/16 6060:00/8 6071:00/16" : "6040:00/16 6071:00/16";
    case DriveMode::ProfileTorque:
      return "6040:00/16 6071:00/16";
    case DriveMode::CyclicSyncPosition:
      return homes ? "6040:00/16 6060:00/8 607A:00/32" : "6040:00/16 607A:00/32";
    case DriveMode::CyclicSyncVelocity:
      return homes ? "6040:00/16 6060:00/8 60FF:00/32" : "6040:00/16 60FF:00/32";
    case DriveMode::ProfilePosition:
      return "6040:00/16 607A:00/32";
    case DriveMode::InterpolatedPosition:
      return "6040:00/16 60C1:01/32";
    default:
      return "6040:00/16 60FF:00/32";
  }
}

const char* default_answers(DriveMode mode, bool homes) {
  if (homes) return "6041:00/16 6061:00/8 6064:00/32";
  return mode == DriveMode::ProfileVelocity ? "6041:00/16 606C:00/32" : "6041:00/16 6064:00/32 6077:00/16";
}

constexpr std::array kModes{DriveMode::ProfilePosition,    DriveMode::ProfileVelocity,
                            DriveMode::ProfileTorque,      DriveMode::InterpolatedPosition,
                            DriveMode::CyclicSyncPosition, DriveMode::CyclicSyncVelocity,
                            DriveMode::CyclicSyncTorque};

Expected<std::vector<MappedObject>> mapping(const Parameters& parameters, const std::string& name, std::size_t axis,
                                            const std::string& otherwise) {
  const std::string text = parameters.text_of_axis(name, axis, otherwise);
  auto objects = read_mapping(text);
  if (!objects) {
    return failure(objects.error().code, parameters.place(fmt::format("{}: {}", name, objects.error().message)));
  }
  return objects;
}

/// The EDS or DCF that an axis names, and who the node is by it.
Expected<> read_description(Parameters& parameters, std::size_t axis, const FindDescription& find, AxisConfig& config) {
  const std::string sheet = parameters.text_of_axis("eds", axis, "");
  const std::string configuration = parameters.text_of_axis("dcf", axis, "");
  if (sheet.empty() && configuration.empty()) return {};
  if (!sheet.empty() && !configuration.empty()) {
    return failure(
        MinorCode::InvalidParameterValue,
        parameters.place(fmt::format("axis {} names both eds and dcf; a DCF says all that its EDS says", axis)));
  }
  if (!find) return failure(MinorCode::UnsupportedOperation, parameters.place("EDS files are not looked for here"));
  auto description = configuration.empty() ? find("eds", sheet) : find("dcf", configuration);
  if (!description) return failure(description.error().code, parameters.place(description.error().message));
  if (config.identity.vendor_id == 0) config.identity.vendor_id = description->vendor_number;
  if (config.identity.product_code == 0) config.identity.product_code = description->product_number;
  config.description = std::make_shared<const eds::DeviceDescription>(std::move(*description));
  return {};
}

/// The contents of a PDO: what device.json says, else what the DCF says, else what the mode needs.
Expected<std::vector<MappedObject>> contents(const Parameters& parameters, const std::string& name, std::size_t axis,
                                             const AxisConfig& config, std::uint16_t mapping_index,
                                             const char* by_mode) {
  std::string otherwise = by_mode;
  if (config.description) {
    const std::string of_file = configured_mapping(*config.description, mapping_index, config.axis_in_node);
    if (!of_file.empty()) otherwise = of_file;
  }
  return mapping(parameters, name, axis, otherwise);
}

SdoWrite setup_write(ObjectAddress object, std::size_t size, double value) {
  SdoWrite write{object, std::vector<std::uint8_t>(size)};
  const std::int64_t whole = std::llround(value);
  for (std::size_t i = 0; i < size; ++i) write.bytes[i] = static_cast<std::uint8_t>(whole >> (8 * i));
  return write;
}

/// How the drive looks for home by itself (CiA 402-2, 13). What is not given is left as it is set in the drive.
void read_homing(Parameters& parameters, std::size_t axis, AxisConfig& config) {
  constexpr double kMostUnsigned = 4294967295.0;
  constexpr double kMostSigned = 2147483647.0;
  constexpr double kAbsent = -1;
  const double method = parameters.number_of_axis("homing_method", axis, 0, -128, 37);
  const double fast = parameters.number_of_axis("homing_speed", axis, kAbsent, 1, kMostUnsigned);
  const double slow = parameters.number_of_axis("homing_speed_slow", axis, kAbsent, 1, kMostUnsigned);
  const double acceleration = parameters.number_of_axis("homing_acceleration", axis, kAbsent, 1, kMostUnsigned);
  const double offset = parameters.number_of_axis("home_offset", axis, std::nan(""), -kMostSigned, kMostSigned);
  if (method == 0) return;
  if (config.mode != DriveMode::CyclicSyncTorque && config.mode != DriveMode::CyclicSyncPosition &&
      config.mode != DriveMode::CyclicSyncVelocity) {
    parameters.refuse(fmt::format("homing_method is {} for axis {}, which does not move a joint", method, axis));
  }
  config.homes = true;
  config.setup.push_back(setup_write({0x6098, 0}, 1, method));
  if (fast != kAbsent) config.setup.push_back(setup_write({0x6099, 1}, 4, fast));
  if (slow != kAbsent) config.setup.push_back(setup_write({0x6099, 2}, 4, slow));
  if (acceleration != kAbsent) config.setup.push_back(setup_write({0x609A, 0}, 4, acceleration));
  if (!std::isnan(offset)) config.setup.push_back(setup_write({0x607C, 0}, 4, offset));
}

/// The sense and the units of a drive's positions (CiA 402-2, 607Eh, 608Fh, 6091h, 6092h). What is not given is left as
/// it is set in the drive.
void read_units(Parameters& parameters, std::size_t axis, AxisConfig& config) {
  struct Unit {
    const char* name;
    ObjectAddress object;
  };
  constexpr std::array kUnits{Unit{"encoder_counts", {0x608F, 1}},   Unit{"encoder_turns", {0x608F, 2}},
                              Unit{"gear_motor_turns", {0x6091, 1}}, Unit{"gear_shaft_turns", {0x6091, 2}},
                              Unit{"feed_counts", {0x6092, 1}},      Unit{"feed_shaft_turns", {0x6092, 2}}};
  constexpr double kAbsent = -1, kMostPolarity = 255, kMost = 4294967295.0;
  const double polarity = parameters.number_of_axis("polarity", axis, kAbsent, 0, kMostPolarity);
  config.sets_polarity = polarity != kAbsent;
  if (config.sets_polarity) config.setup.push_back(setup_write({0x607E, 0}, 1, polarity));
  for (const Unit& unit : kUnits) {
    const double value = parameters.number_of_axis(unit.name, axis, kAbsent, 1, kMost);
    if (value != kAbsent) config.setup.push_back(setup_write(unit.object, 4, value));
  }
  config.check_scale = parameters.number_of_axis("check_scale", axis, 1, 0, 1) != 0;
}

/// Homing is another mode than the cycle's: both sides have to tell which they mean.
bool tells_mode(const AxisConfig& config) {
  const auto holds = [](const std::vector<MappedObject>& objects, std::uint16_t index) {
    return std::any_of(objects.begin(), objects.end(),
                       [index](const MappedObject& object) { return object.object.index == index; });
  };
  return holds(together(config.setpoints, config.more_setpoints), 0x6060) && holds(config.answers, 0x6061);
}

/// The answer that is a sensor's reading; none where none is named.
Expected<std::optional<MappedObject>> sensor_among(Parameters& parameters, std::size_t axis,
                                                   const std::vector<MappedObject>& answers,
                                                   const std::vector<MappedObject>& more) {
  return mapping(parameters, "sensor", axis, "")
      .and_then([&](const std::vector<MappedObject>& named) -> Expected<std::optional<MappedObject>> {
        if (named.empty()) return std::nullopt;
        const auto holds = [&named](const std::vector<MappedObject>& objects) {
          return std::find(objects.begin(), objects.end(), named.front()) != objects.end();
        };
        if (named.size() == 1 && (holds(answers) || holds(more))) return named.front();
        return failure(MinorCode::InvalidParameterValue,
                       parameters.place(fmt::format("sensor of axis {} is \"{}\"; it names one object, as it stands in "
                                                    "that axis's tpdo or second_tpdo, for example 6401:01/16",
                                                    axis, parameters.text_of_axis("sensor", axis, ""))));
      });
}

Expected<AxisConfig> read_axis(Parameters& parameters, std::size_t axis, const FindDescription& find) {
  AxisConfig config;
  config.node = static_cast<std::uint8_t>(parameters.number_of_axis("node", axis, 0, 1, 127));
  config.axis_in_node =
      static_cast<std::uint8_t>(parameters.number_of_axis("axis_in_node", axis, 0, 0, kMostAxesPerNode - 1));
  config.rpdo_node = static_cast<std::uint8_t>(parameters.number_of_axis("rpdo_node", axis, config.node, 1, 127));
  const double mode = parameters.number_of_axis("mode", axis, static_cast<double>(DriveMode::CyclicSyncTorque), 1, 10);
  config.mode = static_cast<DriveMode>(mode);
  if (parameters.sound() && std::find(kModes.begin(), kModes.end(), config.mode) == kModes.end()) {
    parameters.refuse(
        fmt::format("mode is {:g} for axis {}; allowed are 1, 3 and 4 (profile position, velocity and torque), 7 "
                    "(interpolated position), 8, 9 and 10 (cyclic synchronous position, velocity and torque)",
                    mode, axis));
  }
  config.velocity_units_per_rpm =
      parameters.number_of_axis("velocity_units_per_rpm", axis, 1, 1e-6, 1e9, Parameters::Kind::Any);
  constexpr double kMost = 4294967295.0;
  config.identity.vendor_id = static_cast<std::uint32_t>(parameters.number_of_axis("vendor_id", axis, 0, 0, kMost));
  config.identity.product_code =
      static_cast<std::uint32_t>(parameters.number_of_axis("product_code", axis, 0, 0, kMost));
  config.identity.revision_number =
      static_cast<std::uint32_t>(parameters.number_of_axis("revision_number", axis, 0, 0, kMost));
  config.identity.serial_number =
      static_cast<std::uint32_t>(parameters.number_of_axis("serial_number", axis, 0, 0, kMost));
  constexpr double kNotGiven = -1;
  const double sdo_timeout = parameters.number_of_axis("sdo_timeout_ms", axis, kNotGiven, 10, 60000);
  if (sdo_timeout != kNotGiven) config.sdo_timeout = std::chrono::milliseconds(static_cast<int>(sdo_timeout));
  const double delay = parameters.number_of_axis("answer_delay", axis, kNotGiven, 1, kMostAnswerDelay);
  if (delay != kNotGiven) config.answer_delay = static_cast<int>(delay);
  config.drive = parameters.text_of_axis("drive", axis, "");
  read_homing(parameters, axis, config);
  read_units(parameters, axis, config);
  if (!parameters.sound()) return failure(MinorCode::InvalidParameterValue, parameters.problem());

  if (auto read = read_description(parameters, axis, find, config); !read) return tl::unexpected(read.error());
  auto setpoints = contents(parameters, "rpdo", axis, config, 0x1600, default_setpoints(config.mode, config.homes));
  if (!setpoints) return tl::unexpected(setpoints.error());
  auto answers = contents(parameters, "tpdo", axis, config, 0x1A00, default_answers(config.mode, config.homes));
  if (!answers) return tl::unexpected(answers.error());
  if (auto known = check_setpoints(*setpoints); !known) {
    return failure(known.error().code, parameters.place("rpdo: " + known.error().message));
  }
  if (auto known = check_answers(*answers); !known) {
    return failure(known.error().code, parameters.place("tpdo: " + known.error().message));
  }
  auto more_setpoints = mapping(parameters, "second_rpdo", axis, "");
  if (!more_setpoints) return tl::unexpected(more_setpoints.error());
  if (auto known = check_setpoints(together(*setpoints, *more_setpoints)); !known) {
    return failure(known.error().code, parameters.place("second_rpdo: " + known.error().message));
  }
  auto more = mapping(parameters, "second_tpdo", axis, "");
  if (!more) return tl::unexpected(more.error());
  if (auto known = check_answers(together(*answers, *more)); !known) {
    return failure(known.error().code, parameters.place("second_tpdo: " + known.error().message));
  }
  auto sensor = sensor_among(parameters, axis, *answers, *more);
  if (!sensor) return tl::unexpected(sensor.error());
  auto setup = read_setup(parameters.text_of_axis("setup", axis, ""));
  if (!setup) return failure(setup.error().code, parameters.place("setup: " + setup.error().message));
  config.setpoints = std::move(*setpoints);
  config.more_setpoints = std::move(*more_setpoints);
  config.answers = std::move(*answers);
  config.more_answers = std::move(*more);
  config.sensor = *sensor;
  config.setup.insert(config.setup.end(), setup->begin(), setup->end());
  if (config.homes && !tells_mode(config)) {
    return failure(MinorCode::InvalidParameterValue,
                   parameters.place(fmt::format("axis {} has a homing_method, so rpdo must hold 6060:00/8 and tpdo "
                                                "6061:00/8, or neither be given",
                                                axis)));
  }
  return config;
}

std::string check_nodes(const CanopenConfig& config) {
  std::set<std::pair<int, int>> taken;
  for (const AxisConfig& axis : config.axes) {
    if (axis.node == config.master_node) {
      return fmt::format("node {} is the master's own id; give master_node or that drive another", axis.node);
    }
    if (!taken.emplace(axis.node, axis.axis_in_node).second) {
      return fmt::format(
          "node {} stands twice with axis_in_node {}; each drive needs a node id of its own, and each "
          "axis of a drive a number of its own",
          axis.node, axis.axis_in_node);
    }
    const auto of_several = [&](const AxisConfig& other) {
      return other.node == axis.node && (&other != &axis || other.axis_in_node != 0);
    };
    const bool second_rpdo = !axis.more_setpoints.empty();
    if ((second_rpdo || !axis.more_answers.empty()) &&
        std::any_of(config.axes.begin(), config.axes.end(), of_several)) {
      return fmt::format(
          "node {0} has several axes and a second_{1}, whose identifier is that of the second axis; map all that is "
          "needed in {1}",
          axis.node, second_rpdo ? "rpdo" : "tpdo");
    }
  }
  return {};
}

/// Bit i: byte i of an axis's RPDO is its own, and no dummy.
unsigned own_bytes(const AxisConfig& axis) {
  unsigned bytes = 0;
  std::size_t at = 0;
  for (const MappedObject& object : axis.setpoints) {
    for (std::size_t i = 0; i < object.bits / 8U; ++i, ++at) {
      if (object.object.index >= kFirstObject) bytes |= 1U << at;
    }
  }
  return bytes;
}

/// Axes of one RPDO: each leaves the others' bytes to dummies.
std::string check_shared(const CanopenConfig& config) {
  for (const AxisConfig& axis : config.axes) {
    const auto owner = [&](const AxisConfig& other) { return other.node == axis.rpdo_node; };
    if (std::none_of(config.axes.begin(), config.axes.end(), owner)) {
      return fmt::format("rpdo_node is {} for node {}, and no drive of this bus has that id", axis.rpdo_node,
                         axis.node);
    }
    for (const AxisConfig& other : config.axes) {
      if (&other == &axis || setpoint_id(other) != setpoint_id(axis)) continue;
      if (mapped_bytes(axis.setpoints) != mapped_bytes(other.setpoints)) {
        return fmt::format(
            "nodes {} and {} share an RPDO, and map {} and {} bytes of it; fill it up with the dummies "
            "0005:00/8, 0006:00/16 and 0007:00/32",
            axis.node, other.node, mapped_bytes(axis.setpoints), mapped_bytes(other.setpoints));
      }
      if ((own_bytes(axis) & own_bytes(other)) != 0) {
        return fmt::format(
            "nodes {} and {} share an RPDO, and both map some of its bytes; where one maps a setpoint the "
            "other needs the dummies 0005:00/8, 0006:00/16 or 0007:00/32",
            axis.node, other.node);
      }
    }
  }
  return {};
}

}  // namespace

Patience patience_with(const CanopenConfig& config, std::uint8_t node, const DriveDescription* drive) {
  Patience patience;
  const DriveManners manners = drive != nullptr ? drive->manners : DriveManners();
  std::optional<std::chrono::milliseconds> given;
  for (const AxisConfig& axis : config.axes) {
    if (axis.node == node && axis.sdo_timeout) given = std::max(*axis.sdo_timeout, given.value_or(*axis.sdo_timeout));
  }
  patience.sdo_timeout = given.value_or(manners.sdo_timeout.value_or(patience.sdo_timeout));
  patience.boot_timeout = config.boot_timeout.value_or(manners.boot_timeout.value_or(patience.boot_timeout));
  if (manners.sdo_retries) patience.sdo_tries = 1 + *manners.sdo_retries;
  return patience;
}

std::size_t mapped_bytes(const std::vector<MappedObject>& objects) noexcept {
  return std::accumulate(objects.begin(), objects.end(), std::size_t{0},
                         [](std::size_t sum, const MappedObject& object) { return sum + object.bits / 8; });
}

Expected<CanopenConfig> read_canopen_config(const std::string& bus,
                                            const std::map<std::string, std::vector<double>>& numbers,
                                            const std::map<std::string, std::string>& texts, double period_s,
                                            const FindDescription& find, std::shared_ptr<const DriveLibrary> drives) {
  Parameters parameters("CANopenInterface", "node", bus, numbers, texts);
  CanopenConfig config;
  config.drives = std::move(drives);
  config.interface = bus;
  config.period = std::chrono::nanoseconds(std::llround(period_s * 1e9));
  config.bit_rate = static_cast<std::uint32_t>(parameters.number("bit_rate", 1e6, 10e3, 1e6));
  config.load_share = parameters.number("load_share", 80, 1, 100, Parameters::Kind::Any) / 100;
  config.heartbeat = std::chrono::milliseconds(static_cast<int>(parameters.number("heartbeat_ms", 50, 2, 10000)));
  config.time_interval =
      std::chrono::nanoseconds(std::llround(parameters.number("time_s", 0, 0, 3600, Parameters::Kind::Any) * 1e9));
  config.master_node = static_cast<std::uint8_t>(parameters.number("master_node", 127, 1, 127));
  constexpr double kNotGiven = -2;
  const double boot_timeout_s = parameters.number("boot_timeout_s", kNotGiven, 0.1, 600, Parameters::Kind::Any);
  if (boot_timeout_s != kNotGiven) config.boot_timeout = std::chrono::milliseconds(std::llround(boot_timeout_s * 1e3));
  const double abort_connection = parameters.number("abort_connection", kNotGiven, -1, 3);
  if (abort_connection != kNotGiven) config.abort_connection = static_cast<int>(abort_connection);
  config.missed_answers = static_cast<std::uint32_t>(parameters.number("missed_answers", 1, 0, 100));
  const std::string sync = parameters.text("sync", "last");
  if (sync != "first" && sync != "last" && sync != "external") {
    parameters.refuse(fmt::format("sync is \"{}\"; allowed are \"first\", \"last\" and \"external\"", sync));
  }
  config.sync = sync == "first" ? SyncOrder::First : sync == "last" ? SyncOrder::Last : SyncOrder::External;
  const std::size_t axes = parameters.axes();
  if (axes == 0) parameters.refuse("node is missing; it lists the node id of each axis, for example [1, 2, 3]");
  for (std::size_t axis = 0; axis < axes && parameters.sound(); ++axis) {
    auto read = read_axis(parameters, axis, find);
    if (!read) return tl::unexpected(read.error());
    config.axes.push_back(std::move(*read));
  }
  parameters.refuse_unknown();
  if (parameters.sound()) parameters.refuse(check_nodes(config));
  if (parameters.sound()) parameters.refuse(check_shared(config));
  if (parameters.sound()) parameters.refuse(check_chosen_drives(config));
  for (std::size_t axis = 0; axis < axes && parameters.sound(); ++axis) {
    if (auto fits = check_description(config, config.axes[axis]); !fits) {
      parameters.refuse(fmt::format("axis {}: {}", axis, fits.error().message));
    }
  }
  if (!parameters.sound()) return failure(MinorCode::InvalidParameterValue, parameters.problem());
  return config;
}

}  // namespace rmac::fieldbus::canopen
