#include "canopen/boot_plan.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "canopen/description_check.hpp"
#include "canopen/drives/drive_of_node.hpp"
#include "canopen/objects/standard_objects.hpp"
#include "rmac/fieldbus/canopen/stored_parameters.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr std::uint32_t kInvalidPdo = 0x80000000;
constexpr std::uint32_t kNoRemoteRequest = 0x40000000;
constexpr std::uint32_t kByte = 0xFF, kAll = 0xFFFFFFFF;  ///< what of a value is compared

struct InterpolationTime {
  std::int64_t value;
  int exponent;
};

/// As few digits as say it, in ms where they can: the exponent of 60C2h is -3 by default, and in some drives fixed.
std::optional<InterpolationTime> interpolation_time(std::chrono::nanoseconds period,
                                                    const std::optional<InterpolationTimes>& taken) {
  constexpr std::int64_t kMostValue = 255;
  constexpr std::array kExponents{-3, -2, -1, 0, -4, -5, -6, -7, -8, -9};
  for (const int exponent : kExponents) {
    if (taken && taken->index != exponent) continue;
    std::int64_t unit = 1;
    for (int i = -9; i < exponent; ++i) unit *= 10;
    const std::int64_t value = period.count() / unit;
    if (period.count() % unit != 0 || value <= 0 || value > kMostValue) continue;
    const auto& values = taken ? taken->values : std::vector<std::uint8_t>();
    const bool takes = values.empty() || std::find(values.begin(), values.end(), value) != values.end();
    if (takes) return InterpolationTime{value, exponent};
  }
  return std::nullopt;
}

class Plan {
 public:
  using Kind = BootStep::Kind;

  Plan(const CanopenConfig& config, const DriveManners& manners) : config_(config), manners_(manners) {}

  void check_node(const AxisConfig& first) {
    constexpr std::uint32_t kProfileMask = 0xFFFF;
    constexpr std::uint32_t kDriveProfile = 402;
    need("to know that it is a drive").check({0x1000, 0}, kDriveProfile, kProfileMask);
    need("to know that it is the device that device.json names");
    const std::array numbers{first.identity.vendor_id, first.identity.product_code, first.identity.revision_number,
                             first.identity.serial_number};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const ObjectAddress object{0x1018, static_cast<std::uint8_t>(i + 1)};
      if (numbers[i] == 0) {
        read(object);
      } else {
        check(object, numbers[i], 0xFFFFFFFF);
      }
    }
  }

  /// Once more who it is: two devices may have taken turns to answer.
  void read_identity() {
    for (std::uint8_t sub = 1; sub <= 4; ++sub) read({0x1018, sub});
  }

  void refuse(const char* why) { add(Kind::Refuse, {}).needed = why; }

  /// A drive that takes a mapping only with its next reset has it stored where it has another, and is reset.
  void keep_mapping() {
    if (!manners_.store_after_mapping) return;
    need("for its mapping to hold (StoreAfterMapping)");
    BootStep& store = add(Kind::Store, {0x1010, 1});
    store.bytes.assign(kSaveSignature.begin(), kSaveSignature.end());
    store.after_change = true;
    add(Kind::Reset, {}).after_change = true;
  }

  /// From the fall of its voltage to the fall of the master: what a drive does when nobody speaks to it any more.
  void watch_master() {
    if (manners_.node_guarding) {
      constexpr std::uint32_t kLifeTimeFactor = 2;
      like_to().write({0x1017, 0}, 2, 0);  // whoever makes heartbeats is not guarded (CiA 301, 7.2.8.3.2)
      need("for it to stop when the master dies (NodeGuarding)");
      write({0x100C, 0}, 2, static_cast<std::uint32_t>(config_.heartbeat.count()));
      write({0x100D, 0}, 1, kLifeTimeFactor);
      return;
    }
    if (manners_.no_heartbeat_consumer.empty()) {
      need("for it to stop when the master dies")
          .write({0x1016, 1}, 4,
                 static_cast<std::uint32_t>(config_.master_node) << 16 |
                     static_cast<std::uint32_t>(config_.heartbeat_deadline().count()));
    }
    need("to notice when it dies").write({0x1017, 0}, 2, static_cast<std::uint32_t>(config_.heartbeat.count()));
    read({0x1017, 0});  // some round it
  }

  void add_axis(const AxisConfig& axis) {
    const auto offset = static_cast<std::uint16_t>(kAxisOffset * axis.axis_in_node);
    supports(axis, offset);
    silence_others(axis);
    const auto number = static_cast<std::uint16_t>(kPdoOffset * axis.axis_in_node);
    need("to send it its setpoints (rpdo)");
    map(static_cast<std::uint16_t>(0x1400 + number), setpoint_id(axis), axis.setpoints, offset);
    if (!axis.more_setpoints.empty()) {
      need("to send it its setpoints (second_rpdo)");
      map_second(0x1401, more_setpoints_id(axis), axis.more_setpoints, offset);
    }
    need("to have its answers (tpdo)");
    map(static_cast<std::uint16_t>(0x1800 + number), kNoRemoteRequest | answer_id(axis), axis.answers, offset);
    read(transmission_type(axis, false));
    if (!axis.more_answers.empty()) {
      need("to have its answers (second_tpdo)");
      map_second(0x1801, kNoRemoteRequest | more_answers_id(axis), axis.more_answers, offset);
      read(transmission_type(axis, true));
    }
    constexpr int kQuickStop = 3, kNotWritten = -1;
    const int otherwise = manners_.no_abort_connection ? kNotWritten : kQuickStop;
    if (const int option = config_.abort_connection.value_or(otherwise); option >= 0) {
      need("for it to stop when the master dies (where abort_connection is -1 it is not written)");
      write(of_axis({0x6007, 0}, offset), 2, static_cast<std::uint32_t>(option));
    }
    need("to set its mode").write(of_axis({0x6060, 0}, offset), 1, static_cast<std::uint32_t>(axis.mode));
    check_polarity(axis, offset);
    interpolation(axis, offset);
    need("because device.json sets it");
    for (const SdoWrite& setup : axis.setup) write(of_axis(setup.object, offset), setup.bytes);
    if (axis.check_scale && axis.mode != DriveMode::ProfileVelocity) {
      for (const ObjectAddress object : kScaleObjects) read(of_axis(object, offset));
    }
  }

  /// A DCF is of the whole node: its addresses stand as they are.
  void write_configured(const AxisConfig& axis) {
    if (!axis.description) return;
    need("because its DCF sets it");
    for (SdoWrite& configured : configured_writes(*axis.description, axis.node)) {
      if (!skips(configured.object)) write(configured.object, std::move(configured.bytes));
    }
  }

  void read_error() { read({0x603F, 0}); }
  [[nodiscard]] std::vector<BootStep> steps() && { return std::move(steps_); }

 private:
  /// What the steps from here on are for; nothing: they are optional.
  Plan& need(const char* what_for) {
    needed_ = what_for;
    return *this;
  }
  Plan& like_to() { return need(nullptr); }

  BootStep& add(Kind kind, ObjectAddress object) {
    return steps_.emplace_back(BootStep{.kind = kind,
                                        .object = object,
                                        .bytes = {},
                                        .optional = needed_ == nullptr,
                                        .needed = needed_ != nullptr ? needed_ : ""});
  }
  /// `object` may be that of any axis of the node.
  [[nodiscard]] bool skips(ObjectAddress object) const {
    return std::any_of(manners_.skip.begin(), manners_.skip.end(), [&](const SkippedObject& skipped) {
      return skipped.index == of_first_axis(object).index && skipped.sub.value_or(object.sub) == object.sub;
    });
  }
  void read(ObjectAddress object) {
    if (!skips(object)) add(Kind::Read, object).optional = true;
  }
  BootStep& check(ObjectAddress object, std::uint32_t value, std::uint32_t mask) {
    BootStep& step = add(Kind::Check, object);
    step.value = value;
    step.mask = mask;
    return step;
  }
  void write(ObjectAddress object, std::vector<std::uint8_t> bytes) {
    add(Kind::Write, object).bytes = std::move(bytes);
  }
  void write(ObjectAddress object, std::size_t size, std::uint32_t value) {
    std::vector<std::uint8_t> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    write(object, std::move(bytes));
  }
  /// A parameter of a PDO on its way to `last`, which a drive may have as a constant (CiA 301, 7.5.2.35 to 7.5.2.38).
  void write_pdo(ObjectAddress object, std::size_t size, std::uint32_t value, std::uint32_t last, std::uint32_t mask) {
    write(object, size, value);
    BootStep& step = steps_.back();
    step.may_be_constant = true;
    step.mask = mask;
    step.value = last & step.mask;
  }

  /// Supported drive modes: bit 0 is mode 1, and so on (CiA 402-2, 6502h).
  void supports(const AxisConfig& axis, std::uint16_t offset) {
    const std::uint32_t bit = 1U << (static_cast<unsigned>(axis.mode) - 1);
    const std::uint32_t homing = axis.homes ? 1U << (static_cast<unsigned>(DriveMode::Homing) - 1) : 0;
    if (const ObjectAddress modes = of_axis({0x6502, 0}, offset); !skips(modes)) {
      like_to().check(modes, bit | homing, bit | homing);
    }
  }

  /// A drive that turns positions round and torques not would run away from its setpoint (607Eh, bit 7).
  void check_polarity(const AxisConfig& axis, std::uint16_t offset) {
    constexpr std::uint32_t kPosition = 0x80;
    if (axis.mode != DriveMode::CyclicSyncTorque || axis.sets_polarity) return;
    need("to know that its positions run with its torques (where polarity is given it is not asked)")
        .check(of_axis({0x607E, 0}, offset), 0, kPosition)
        .may_be_absent = true;
  }

  /// PDOs that a drive has by default would load the bus beside what is counted.
  void silence_others(const AxisConfig& axis) {
    if (axis.axis_in_node != 0) return;
    constexpr std::uint16_t kDefaultPdos = 4;
    const auto of_another = [&](auto id_of, std::uint32_t id) {
      return std::any_of(config_.axes.begin(), config_.axes.end(),
                         [&](const AxisConfig& other) { return other.axis_in_node != 0 && id_of(other) == id; });
    };
    // What one axis sent there, or took from there, another would take or send.
    const auto silence = [&](std::uint16_t communication, std::uint32_t cob_id, bool taken) {
      if (!taken && skips({communication, 1})) return;
      (taken ? need("because another axis has its identifier") : like_to()).write({communication, 1}, 4, cob_id);
    };
    for (std::uint16_t pdo = 1; pdo < kDefaultPdos; ++pdo) {
      const std::uint32_t setpoints = 0x200U + 0x100U * pdo + axis.node;
      const std::uint32_t answers = 0x180U + 0x100U * pdo + axis.node;
      silence(static_cast<std::uint16_t>(0x1400 + pdo), kInvalidPdo | setpoints, of_another(setpoint_id, setpoints));
      silence(static_cast<std::uint16_t>(0x1800 + pdo), kInvalidPdo | kNoRemoteRequest | answers,
              of_another(answer_id, answers));
    }
  }

  /// The order that CiA 301, 7.5.2.36 asks for: invalid, no entries, entries, their number, valid again.
  void map(std::uint16_t communication, std::uint32_t cob_id, const std::vector<MappedObject>& objects,
           std::uint16_t offset) {
    const auto contents = static_cast<std::uint16_t>(communication + 0x200);
    std::vector<std::uint32_t> entries;
    for (const MappedObject& object : objects) {
      const ObjectAddress at = of_axis(object.object, offset);
      entries.push_back(static_cast<std::uint32_t>(at.index) << 16 | at.sub << 8 | object.bits);
    }
    if (manners_.store_after_mapping) compare_contents(Kind::Compare, contents, entries);
    write_pdo({communication, 1}, 4, kInvalidPdo | cob_id, cob_id, ~kNoRemoteRequest);
    write_pdo({communication, 2}, 1, kEverySync, kEverySync, kByte);
    if (manners_.fixed_mapping) {
      const char* const what_for = needed_;
      need("because its mapping is fixed (FixedMapping): rpdo and tpdo must say what it has");
      compare_contents(Kind::Check, contents, entries);
      need(what_for);
    } else {
      write_contents(contents, entries);
    }
    write_pdo({communication, 1}, 4, cob_id, cob_id, ~kNoRemoteRequest);
  }

  void map_second(std::uint16_t communication, std::uint32_t cob_id, const std::vector<MappedObject>& objects,
                  std::uint16_t offset) {
    if (skips({communication, 1})) {
      return refuse("its second PDO is to be left alone (Skip), and second_rpdo or second_tpdo maps it");
    }
    map(communication, cob_id, objects, offset);
  }

  void write_contents(std::uint16_t contents, const std::vector<std::uint32_t>& entries) {
    const std::size_t first = steps_.size();
    const auto count = static_cast<std::uint32_t>(entries.size());
    write_pdo({contents, 0}, 1, 0, count, kByte);
    std::uint8_t sub = 0;
    for (const std::uint32_t entry : entries) write_pdo({contents, ++sub}, 4, entry, entry, kAll);
    write_pdo({contents, 0}, 1, count, count, kByte);
    for (std::size_t i = first; i < steps_.size(); ++i) steps_[i].after_change = manners_.store_after_mapping;
  }

  void compare_contents(Kind kind, std::uint16_t contents, const std::vector<std::uint32_t>& entries) {
    const auto compare = [&](std::uint8_t sub, std::uint32_t value, std::uint32_t mask) {
      BootStep& step = add(kind, {contents, sub});
      step.value = value;
      step.mask = mask;
    };
    compare(0, static_cast<std::uint32_t>(entries.size()), kByte);
    std::uint8_t sub = 0;
    for (const std::uint32_t entry : entries) compare(++sub, entry, kAll);
  }

  /// The period, for drives that interpolate: 60C2h as value times a power of ten, in s. A drive may have it fixed, and
  /// then it must be what is wanted where the drive moves from one setpoint to the next within it.
  void interpolation(const AxisConfig& axis, std::uint16_t offset) {
    const bool interpolates =
        axis.mode == DriveMode::InterpolatedPosition || axis.mode == DriveMode::CyclicSyncPosition;
    const auto time = interpolation_time(config_.period, manners_.interpolation);
    const auto sets = [](const SdoWrite& setup) { return setup.object.index == 0x60C2; };
    if (!time && manners_.interpolation && interpolates && std::none_of(axis.setup.begin(), axis.setup.end(), sets)) {
      refuse("the cycle (period_s) is none of the times that it takes in 60C2h (InterpolationTimePeriod)");
    }
    if (!time) return;
    const std::array numbers{static_cast<std::uint32_t>(time->value), static_cast<std::uint32_t>(time->exponent)};
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      const ObjectAddress object = of_axis({0x60C2, static_cast<std::uint8_t>(i + 1)}, offset);
      if (skips(object)) continue;
      like_to().write(object, 1, numbers[i] & kByte);
      if (!interpolates) continue;
      BootStep& told = check(object, numbers[i] & kByte, kByte);
      told.after_refusal = true;
      told.needed = "to interpolate between setpoints over a cycle (modes 7 and 8)";
    }
  }

  const CanopenConfig& config_;
  const DriveManners& manners_;
  std::vector<BootStep> steps_;
  const char* needed_ = nullptr;
};

}  // namespace

std::vector<BootStep> boot_plan(const CanopenConfig& config, std::uint8_t node, const DriveDescription* drive) {
  const DriveManners manners = drive != nullptr ? drive->manners : DriveManners();
  Plan plan(config, manners);
  bool first = true;
  for (const AxisConfig& axis : config.axes) {
    if (axis.node != node) continue;
    if (first) {
      plan.check_node(axis);
      if (drive != nullptr && !drive->refusal.empty()) {
        plan.refuse(drive->refusal.c_str());
        return std::move(plan).steps();
      }
      plan.write_configured(axis);
    }
    first = false;
    plan.add_axis(axis);
  }
  plan.keep_mapping();
  plan.read_identity();
  plan.watch_master();
  plan.read_error();
  return std::move(plan).steps();
}

BootPlans::BootPlans(const CanopenConfig& config, std::uint8_t node) {
  for (const DriveDescription* drive : possible_drives(config, node)) {
    plans_.push_back({drive, patience_with(config, node, drive), boot_plan(config, node, drive)});
  }
}

void BootPlans::choose(const Identity& told) noexcept {
  if (plans_.size() == 1) return;  // device.json says by which it goes
  const auto fits = [&](const Plan& plan) { return plan.drive != nullptr && plan.drive->covers(told); };
  const auto none = [](const Plan& plan) { return plan.drive == nullptr; };
  auto found = std::find_if(plans_.begin(), plans_.end(), fits);
  if (found == plans_.end()) found = std::find_if(plans_.begin(), plans_.end(), none);
  at_ = static_cast<std::size_t>(found - plans_.begin());
}

std::size_t BootPlans::longest() const noexcept {
  std::size_t steps = 0;
  for (const Plan& plan : plans_) steps = std::max(steps, plan.steps.size());
  return steps;
}

}  // namespace rmac::fieldbus::canopen
