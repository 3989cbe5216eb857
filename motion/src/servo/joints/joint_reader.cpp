#include "servo/joints/joint_reader.hpp"

#include <algorithm>
#include <cmath>

#include "rmac/motion/servo/pitch_error.hpp"

namespace rmac {

namespace {

/// What a joint comes back with from what stopped it is less than it came with, so long ago.
constexpr double kFadesS = 0.02;

}  // namespace

JointReader::JointReader(const ServoLoopParts& parts, const Wiring& wiring, Transmission& transmission)
    : joints_(parts.joints),
      period_s_(parts.period_s),
      fades_(std::exp(-parts.period_s / kFadesS)),
      transmission_(transmission),
      efforts_(*parts.actuator_map, wiring, parts.actuators) {}

void JointReader::read(std::span<const double> shafts, std::span<const double> shaft_velocities, IndexSet live,
                       IndexSet steady, std::span<const double> velocity_set) noexcept {
  const std::size_t count = joints_.size();
  transmission_.map().joint_positions(shafts, {position_.data(), count});
  transmission_.map().joint_velocities(shafts, shaft_velocities, {velocity_.data(), count});
  for (std::size_t j = 0; j < count; ++j) {
    read_jump(j, position_[j], has(steady, j));
    if (const auto& sensor = joints_[j].force_sensor) {
      const DriveFeedback& words = sensor->bus->feedback[sensor->axis];
      force_[j] = (static_cast<double>(words.sensor_counts) - sensor->zero_counts) * sensor->newton_per_count;
    }
    PositionCorrection& correction = transmission_.correction(j);
    correction.follow(has(live, j) ? velocity_set[j] : 0, period_s_);
    velocity_[j] = correction.actual_velocity(position_[j], velocity_[j]);
    position_[j] = correction.actual(position_[j]);
  }
  efforts_.read(positions());
}

void JointReader::read_jump(std::size_t joint, double position, bool steady) noexcept {
  Shown& shown = shown_[joint];
  const double step = position - shown.last;
  shown.step.reset();
  if (shown.history > 0 && steady) shown.step = step;
  shown.jump = steady && shown.history == 2 ? step - (shown.last - shown.before) : 0;
  shown.may_stop = std::abs(step) <= shown.fastest + joints_[joint].bounds.jump / 2;
  shown.fastest *= fades_;
  if (shown.history > 0) shown.fastest = std::max(shown.fastest, std::abs(step));
  shown.before = shown.last;
  shown.last = position;
  shown.history = steady ? static_cast<std::uint8_t>(std::min(shown.history + 1, 2)) : std::uint8_t{0};
}

void JointReader::reflect(std::span<const double> position_set, std::span<const double> velocity_set) noexcept {
  std::copy(position_set.begin(), position_set.end(), position_.begin());
  std::copy(velocity_set.begin(), velocity_set.end(), velocity_.begin());
}

std::array<double, kMaxJoints> JointReader::at_loads(std::span<const double> loads_rad) const noexcept {
  std::array<double, kMaxJoints> joints{};
  transmission_.map().joint_positions(loads_rad, {joints.data(), joints_.size()});
  for (std::size_t j = 0; j < joints_.size(); ++j) joints[j] += pitch_error(joints_[j].mechanics.pitch, joints[j]);
  return joints;
}

}  // namespace rmac
