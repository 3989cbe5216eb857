#include "canopen/boot_plan.hpp"

#include <array>

#include "canopen/description_check.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using Kind = BootStep::Kind;

constexpr std::uint32_t kInvalidPdo = 0x80000000;
constexpr std::uint32_t kNoRemoteRequest = 0x40000000;

class Plan {
 public:
  explicit Plan(const CanopenConfig& config) : config_(config) {}

  void check_node(const AxisConfig& first) {
    constexpr std::uint32_t kProfileMask = 0xFFFF;
    constexpr std::uint32_t kDriveProfile = 402;
    check({0x1000, 0}, kDriveProfile, kProfileMask);
    const std::array numbers{first.identity.vendor_id, first.identity.product_code, first.identity.revision_number,
                             first.identity.serial_number};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const ObjectAddress object{0x1018, static_cast<std::uint8_t>(i + 1)};
      numbers[i] != 0 ? check(object, numbers[i], 0xFFFFFFFF) : read(object);
    }
  }

  /// Once more who it is: two devices may have taken turns to answer.
  void read_identity() {
    for (std::uint8_t sub = 1; sub <= 4; ++sub) read({0x1018, sub});
  }

  /// From the fall of its voltage to the fall of the master: what a drive does when nobody speaks to it any more.
  void watch_master() {
    write({0x1016, 1}, 4,
          static_cast<std::uint32_t>(config_.master_node) << 16 |
              static_cast<std::uint32_t>(config_.heartbeat_deadline().count()));
    write({0x1017, 0}, 2, static_cast<std::uint32_t>(config_.heartbeat.count()));
    read({0x1017, 0});  // some round it
  }

  void add_axis(const AxisConfig& axis) {
    const auto offset = static_cast<std::uint16_t>(kAxisOffset * axis.axis_in_node);
    supports(axis, offset);
    silence_others(axis);
    const auto number = static_cast<std::uint16_t>(kPdoOffset * axis.axis_in_node);
    map(static_cast<std::uint16_t>(0x1400 + number), setpoint_id(axis), axis.setpoints, offset);
    map(static_cast<std::uint16_t>(0x1800 + number), kNoRemoteRequest | answer_id(axis), axis.answers, offset);
    read(transmission_type(axis, false));
    if (!axis.more_answers.empty()) {
      map(0x1801, kNoRemoteRequest | more_answers_id(axis), axis.more_answers, offset);
      read(transmission_type(axis, true));
    }
    if (config_.abort_connection >= 0) {
      write(of_axis({0x6007, 0}, offset), 2, static_cast<std::uint32_t>(config_.abort_connection));
    }
    write(of_axis({0x6060, 0}, offset), 1, static_cast<std::uint32_t>(axis.mode));
    check_polarity(axis, offset);
    interpolation(offset);
    for (const SdoWrite& setup : axis.setup) {
      steps_.push_back({.kind = Kind::Write, .object = of_axis(setup.object, offset), .bytes = setup.bytes});
    }
    if (axis.check_scale && axis.mode != DriveMode::ProfileVelocity) {
      for (const ObjectAddress object : kScaleObjects) read(of_axis(object, offset));
    }
  }

  /// A DCF is of the whole node: its addresses stand as they are.
  void write_configured(const AxisConfig& axis) {
    if (!axis.description) return;
    for (SdoWrite& configured : configured_writes(*axis.description, axis.node)) {
      steps_.push_back({.kind = Kind::Write, .object = configured.object, .bytes = std::move(configured.bytes)});
    }
  }

  void read_error() { read({0x603F, 0}); }
  [[nodiscard]] std::vector<BootStep> steps() && { return std::move(steps_); }

 private:
  void read(ObjectAddress object) {
    steps_.push_back({.kind = Kind::Read, .object = object, .bytes = {}, .optional = true});
  }
  void check(ObjectAddress object, std::uint32_t value, std::uint32_t mask, bool optional = false) {
    steps_.push_back(
        {.kind = Kind::Check, .object = object, .bytes = {}, .value = value, .mask = mask, .optional = optional});
  }
  void write(ObjectAddress object, std::size_t size, std::uint32_t value, bool optional = false) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    steps_.push_back({.kind = Kind::Write, .object = object, .bytes = std::move(bytes), .optional = optional});
  }

  /// Supported drive modes: bit 0 is mode 1, and so on (CiA 402-2, 6502h).
  void supports(const AxisConfig& axis, std::uint16_t offset) {
    const std::uint32_t bit = 1U << (static_cast<unsigned>(axis.mode) - 1);
    const std::uint32_t homing = axis.homes ? 1U << (static_cast<unsigned>(DriveMode::Homing) - 1) : 0;
    check(of_axis({0x6502, 0}, offset), bit | homing, bit | homing, true);
  }

  /// A drive that turns positions round and torques not would run away from its setpoint (607Eh, bit 7).
  void check_polarity(const AxisConfig& axis, std::uint16_t offset) {
    constexpr std::uint32_t kPosition = 0x80;
    if (axis.mode != DriveMode::CyclicSyncTorque || axis.sets_polarity) return;
    check(of_axis({0x607E, 0}, offset), 0, kPosition, true);
  }

  /// PDOs that a drive has by default would load the bus beside what is counted.
  void silence_others(const AxisConfig& axis) {
    if (axis.axis_in_node != 0) return;
    constexpr std::uint16_t kDefaultPdos = 4;
    for (std::uint16_t pdo = 1; pdo < kDefaultPdos; ++pdo) {
      const std::uint32_t setpoints = 0x200U + 0x100U * pdo + axis.node;
      const std::uint32_t answers = 0x180U + 0x100U * pdo + axis.node;
      write({static_cast<std::uint16_t>(0x1400 + pdo), 1}, 4, kInvalidPdo | setpoints, true);
      write({static_cast<std::uint16_t>(0x1800 + pdo), 1}, 4, kInvalidPdo | kNoRemoteRequest | answers, true);
    }
  }

  /// The order that CiA 301, 7.5.2.36 asks for: invalid, no entries, entries, their number, valid again.
  void map(std::uint16_t communication, std::uint32_t cob_id, const std::vector<MappedObject>& objects,
           std::uint16_t offset) {
    const auto contents = static_cast<std::uint16_t>(communication + 0x200);
    write({communication, 1}, 4, kInvalidPdo | cob_id);
    write({communication, 2}, 1, kEverySync);
    write({contents, 0}, 1, 0);
    std::uint8_t entry = 0;
    for (const MappedObject& object : objects) {
      const ObjectAddress at = of_axis(object.object, offset);
      write({contents, ++entry}, 4, static_cast<std::uint32_t>(at.index) << 16 | at.sub << 8 | object.bits);
    }
    write({contents, 0}, 1, entry);
    write({communication, 1}, 4, cob_id);
  }

  /// The period, for drives that interpolate: 60C2h as value times a power of ten, in s, where one of 8 bits says it.
  void interpolation(std::uint16_t offset) {
    auto value = config_.period.count();  // ns
    int exponent = -9;
    while (value % 10 == 0 && value > 0) {
      value /= 10;
      ++exponent;
    }
    constexpr std::int64_t kMostValue = 255;
    if (value <= kMostValue) {
      write(of_axis({0x60C2, 1}, offset), 1, static_cast<std::uint32_t>(value), true);
      write(of_axis({0x60C2, 2}, offset), 1, static_cast<std::uint32_t>(exponent) & 0xFF, true);
    }
  }

  const CanopenConfig& config_;
  std::vector<BootStep> steps_;
};

}  // namespace

std::vector<BootStep> boot_plan(const CanopenConfig& config, std::uint8_t node) {
  Plan plan(config);
  bool first = true;
  for (const AxisConfig& axis : config.axes) {
    if (axis.node != node) continue;
    if (first) {
      plan.check_node(axis);
      plan.write_configured(axis);
    }
    first = false;
    plan.add_axis(axis);
  }
  plan.read_identity();
  plan.watch_master();
  plan.read_error();
  return std::move(plan).steps();
}

}  // namespace rmac::fieldbus::canopen
