#include "rmac/fieldbus/canopen/drive_trial.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/motion/drive_power.hpp"

namespace rmac::fieldbus::canopen {
namespace {

constexpr double kPatience_s = 5;  // for a drive to do what it was told
// Bits of controlword and statusword that belong to a mode (CiA 402-2, 10 and 12).
constexpr std::uint16_t kNewSetpoint = 1U << 4, kAtOnce = 1U << 5, kInterpolates = 1U << 4;
constexpr std::uint16_t kInternalLimit = 1U << 11, kAcknowledged = 1U << 12;

/// From 0 to 1 with velocity and acceleration zero at both ends.
double smooth(double share) noexcept {
  const double u = std::clamp(share, 0.0, 1.0);
  return u * u * u * (10 + u * (-15 + 6 * u));
}

bool is_position(DriveMode mode) noexcept {
  return mode == DriveMode::ProfilePosition || mode == DriveMode::InterpolatedPosition ||
         mode == DriveMode::CyclicSyncPosition;
}

std::int64_t tolerance(const DriveTrial& trial) noexcept {
  constexpr std::int64_t kLeast = 10, kPart = 100;
  if (trial.tolerance_counts > 0) return trial.tolerance_counts;
  return std::max(kLeast, std::abs(std::int64_t{trial.amount}) / kPart);
}

class Trial {
 public:
  Trial(CanopenInterface& bus, const CanopenConfig& config, const DriveTrial& wanted, const std::function<void()>& pass)
      : bus_(bus), wanted_(wanted), pass_(pass), period_s_(std::chrono::duration<double>(config.period).count()) {
    command_.mode = wanted.mode;
  }

  Expected<DriveTrialResult> run() {
    auto done = enable().and_then([&] { return move(); }).and_then([&] { return arrived(); });
    result_.to_counts = feedback_.position_counts;
    disable();
    if (!done) return tl::unexpected(done.error());
    return result_;
  }

 private:
  Expected<> cycle(DriveWish wish, std::uint16_t mode_bits = 0) {
    command_.controlword =
        static_cast<std::uint16_t>(next_controlword(feedback_.statusword, wish, false, command_.controlword));
    if (drive_state(feedback_.statusword) == DriveState::OperationEnabled) command_.controlword |= mode_bits;
    const bool sound = bus_.exchange({&command_, 1}, {&feedback_, 1});
    pass_();
    if (!sound) return failure(MinorCode::CommTimeout, "the bus fails; check cable, termination and bit rate");
    return {};
  }

  Expected<> sound() const {
    if (!feedback_.online) return failure(MinorCode::CommTimeout, "the drive does not answer any more");
    const DriveState state = drive_state(feedback_.statusword);
    if (state != DriveState::Fault && state != DriveState::FaultReactionActive) return {};
    return failure(MinorCode::Other, fmt::format("the drive reports error {:04X}h ({})", feedback_.error_code,
                                                 emergency_text(feedback_.error_code)));
  }

  Expected<> enable() {
    // The feedback of the first cycle answers nothing yet.
    for (int i = 0; i < 3; ++i) {
      if (auto sent = cycle(DriveWish::Off); !sent) return sent;
    }
    if (auto fine = sound(); !fine) return fine;
    result_.from_counts = feedback_.position_counts;
    for (double waited_s = 0; drive_state(feedback_.statusword) != DriveState::OperationEnabled;
         waited_s += period_s_) {
      command_.target_position_counts = feedback_.position_counts;
      if (auto sent = cycle(DriveWish::Operational); !sent) return sent;
      if (auto fine = sound(); !fine) return fine;
      if (waited_s > kPatience_s) {
        return failure(MinorCode::ResponseTimeout,
                       fmt::format("the drive was not enabled within {:g} s, it stays in {}; check its power and its "
                                   "enable chain",
                                   kPatience_s, drive_state_text(feedback_.statusword)));
      }
    }
    return {};
  }

  /// One cycle under way; `done` ends it. Fails where the drive goes too far or too long.
  Expected<> step(std::uint16_t mode_bits, double most_s) {
    if (auto sent = cycle(DriveWish::Operational, mode_bits); !sent) return sent;
    result_.seconds += period_s_;
    if (auto fine = sound(); !fine) return fine;
    if (drive_state(feedback_.statusword) != DriveState::OperationEnabled) {
      return failure(MinorCode::Other, fmt::format("the drive left Operation Enabled by itself and is in {}",
                                                   drive_state_text(feedback_.statusword)));
    }
    const std::int64_t went = std::abs(std::int64_t{feedback_.position_counts} - result_.from_counts);
    result_.farthest_counts = std::max(result_.farthest_counts, went);
    if (went > wanted_.most_counts) {
      return failure(MinorCode::TravelLimit, fmt::format("the drive went {} counts from where it stood, and {} are "
                                                         "allowed; it was stopped",
                                                         went, wanted_.most_counts));
    }
    if (result_.seconds > most_s) {
      return failure(MinorCode::ResponseTimeout,
                     fmt::format("the drive did not say in {:g} s that it is through; it is {} counts from where it "
                                 "stood (statusword {:04X}h)",
                                 most_s, went, feedback_.statusword));
    }
    return {};
  }

  Expected<> move() {
    switch (wanted_.mode) {
      case DriveMode::ProfilePosition:
        return by_profile();
      case DriveMode::InterpolatedPosition:
        return along_path(kInterpolates);
      case DriveMode::CyclicSyncPosition:
        return along_path(0);
      default:
        return for_a_time();
    }
  }

  /// The handshake of a set-point: new, acknowledged, taken back, reached.
  Expected<> by_profile() {
    const double most_s = wanted_.seconds + kPatience_s;
    command_.target_position_counts = result_.from_counts + wanted_.amount;
    for (const bool told : {false, true, false}) {
      const std::uint16_t bits = told ? kNewSetpoint | kAtOnce : 0;
      do {
        if (auto fine = step(bits, most_s); !fine) return fine;
      } while (((feedback_.statusword & kAcknowledged) != 0) != told);
    }
    while ((feedback_.statusword & statusword::kTargetReached) == 0) {
      if (auto fine = step(0, most_s); !fine) return fine;
    }
    return {};
  }

  Expected<> along_path(std::uint16_t mode_bits) {
    const double most_s = wanted_.seconds + kPatience_s;
    const double settle_s = 0.2;
    for (double t_s = 0; t_s < wanted_.seconds + settle_s; t_s += period_s_) {
      command_.target_position_counts =
          result_.from_counts + static_cast<std::int32_t>(std::lround(wanted_.amount * smooth(t_s / wanted_.seconds)));
      if (auto fine = step(mode_bits, most_s); !fine) return fine;
    }
    return {};
  }

  Expected<> for_a_time() {
    const double most_s = wanted_.seconds + kPatience_s;
    const bool torque = wanted_.mode == DriveMode::ProfileTorque || wanted_.mode == DriveMode::CyclicSyncTorque;
    for (double t_s = 0; t_s < wanted_.seconds; t_s += period_s_) {
      if (torque) command_.target_torque_permille = static_cast<std::int16_t>(wanted_.amount);
      if (!torque) command_.target_velocity_rpm = wanted_.amount;
      if (auto fine = step(0, most_s); !fine) return fine;
    }
    return {};
  }

  /// Whether a mode of position ended where it was to.
  Expected<> arrived() const {
    if (!is_position(wanted_.mode)) return {};
    const std::int64_t went = std::int64_t{feedback_.position_counts} - result_.from_counts;
    const std::int64_t off = std::abs(went - wanted_.amount);
    if (off <= tolerance(wanted_)) return {};
    return failure(
        MinorCode::Other,
        fmt::format("the drive went {} counts and not {}: it stands {} off, and {} are allowed (statusword {:04X}h{}); "
                    "look for a limit switch, a block, or limits of the drive's own",
                    went, wanted_.amount, off, tolerance(wanted_), feedback_.statusword,
                    (feedback_.statusword & kInternalLimit) != 0 ? ", internal limit active" : ""));
  }

  /// By a quick stop to rest, then off; nothing that fails here changes that the bus is stopped next.
  void disable() {
    command_.target_torque_permille = 0;
    command_.target_velocity_rpm = 0;
    std::int32_t before = feedback_.position_counts;
    int still = 0;
    for (double waited_s = 0; waited_s < kPatience_s && still < 5; waited_s += period_s_) {
      if (!cycle(DriveWish::QuickStop)) return;
      still = std::abs(feedback_.position_counts - before) <= 2 ? still + 1 : 0;
      before = feedback_.position_counts;
    }
    for (int i = 0; i < 5; ++i) (void)cycle(DriveWish::Off);
  }

  CanopenInterface& bus_;
  DriveTrial wanted_;
  const std::function<void()>& pass_;
  double period_s_;
  DriveCommand command_;
  DriveFeedback feedback_;
  DriveTrialResult result_;
};

}  // namespace

Expected<DriveTrialResult> try_drive(CanopenInterface& bus, const CanopenConfig& config, const DriveTrial& trial,
                                     const std::function<void()>& pass) {
  const auto refuse = [](std::string what) { return failure(MinorCode::InvalidParameterValue, std::move(what)); };
  if (bus.axis_count() != 1) return refuse("one drive is tried at a time");
  const auto& answers = config.axes.front().answers;
  if (std::none_of(answers.begin(), answers.end(),
                   [](const MappedObject& told) { return told.object.index == 0x6064; })) {
    return refuse("the drive does not tell its position (tpdo lacks 6064h), which a trial watches");
  }
  if (trial.mode == DriveMode::None || trial.mode == DriveMode::Homing) {
    return refuse("a trial is by a mode of position, velocity or torque");
  }
  if (!(trial.seconds > 0) || trial.most_counts <= 0) return refuse("a trial needs a time and a way above 0");
  if (is_position(trial.mode) && std::abs(std::int64_t{trial.amount}) > trial.most_counts) {
    return refuse(
        fmt::format("a way of {} counts is more than the {} that are allowed", trial.amount, trial.most_counts));
  }
  constexpr std::int32_t kMostTorque = 32767;
  const bool torque = trial.mode == DriveMode::ProfileTorque || trial.mode == DriveMode::CyclicSyncTorque;
  if (torque && std::abs(trial.amount) > kMostTorque) return refuse("a torque is 32767 per mille at most");
  return Trial(bus, config, trial, pass).run();
}

}  // namespace rmac::fieldbus::canopen
