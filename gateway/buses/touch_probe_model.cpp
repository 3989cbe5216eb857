#include "gateway/buses/touch_probe_model.hpp"

#include <cmath>
#include <numbers>

#include "rmac/motion/servo/pitch_error.hpp"

namespace rmac::gateway {
namespace {

std::uint64_t mask(int bit) noexcept {
  return bit < 0 ? 0 : std::uint64_t{1} << bit;
}

}  // namespace

TouchProbeModel::TouchProbeModel(std::shared_ptr<fieldbus::SimulatedIoInterface> io, const ServoLoopParts& parts,
                                 std::vector<Shaft> shafts, std::optional<Spindle> spindle)
    : io_(std::move(io)),
      probe_(*io_->probe()),
      kinematics_(parts.kinematics),
      map_(parts.actuator_map),
      axes_(parts.joints.size()),
      period_s_(parts.period_s),
      shafts_(std::move(shafts)),
      spindle_(std::move(spindle)),
      powered_(probe_.switch_rpm == 0) {
  for (const ServoJoint& joint : parts.joints) pitch_.push_back(joint.mechanics.pitch);
}

double TouchProbeModel::distance(std::span<const double> shown) const noexcept {
  std::array<double, kMaxJoints> joints{};
  for (std::size_t j = 0; j < axes_; ++j) joints[j] = shown[j] + pitch_error(pitch_[j], shown[j]);
  Frame stylus;
  stylus.p = probe_.stylus;
  ToolPose tip;
  kinematics_->forward({joints.data(), kinematics_->joint_count()}, stylus, tip);
  return io_->part().distance(tip.tip) - probe_.radius;
}

TouchProbeModel::Instant TouchProbeModel::look() const noexcept {
  Instant seen;
  std::array<double, kMaxJoints> shaft{}, speed{};
  for (std::size_t i = 0; i < shafts_.size(); ++i) {
    const Shaft& at = shafts_[i];
    const fieldbus::AxisPlant& plant = at.bus->plant(at.axis);
    const double home = at.scale.home_counts * (2 * std::numbers::pi / at.scale.counts_per_revolution);
    shaft[i] = at.scale.direction * (plant.load_rad() - home);
    speed[i] = at.scale.direction * plant.load_rad_s();
  }
  map_->joint_positions({shaft.data(), shafts_.size()}, {seen.position.data(), axes_});
  map_->joint_velocities({shaft.data(), shafts_.size()}, {speed.data(), shafts_.size()}, {seen.velocity.data(), axes_});
  seen.distance = distance(seen.position);
  return seen;
}

std::array<double, kMaxJoints> TouchProbeModel::joints_between(const Instant& from, const Instant& to,
                                                               double share) const noexcept {
  const double u = share, v = 1 - share;
  std::array<double, kMaxJoints> joints{};
  for (std::size_t j = 0; j < axes_; ++j) {
    joints[j] = v * v * ((1 + 2 * u) * from.position[j] + u * period_s_ * from.velocity[j]) +
                u * u * ((1 + 2 * v) * to.position[j] - v * period_s_ * to.velocity[j]);
  }
  return joints;
}

double TouchProbeModel::change_of_contact(const Instant& from, const Instant& to) const noexcept {
  double before = 0, after = 1;
  for (int i = 0; i < 40; ++i) {
    const double middle = (before + after) / 2;
    const bool free = distance(joints_between(from, to, middle)) > 0;
    (free == (from.distance > 0) ? before : after) = middle;
  }
  return after;
}

void TouchProbeModel::touch_drives(const Instant& from, const Instant& to) noexcept {
  const bool touches = from.distance > 0 && to.distance <= 0;
  const bool lets_go = from.distance <= 0 && to.distance > 0;
  if (!powered_ || !(touches || lets_go)) return;
  const auto joints = joints_between(from, to, change_of_contact(from, to));
  std::array<double, kMaxJoints> angles{};
  map_->actuator_positions({joints.data(), axes_}, {angles.data(), shafts_.size()});
  for (std::size_t i = 0; i < shafts_.size(); ++i) {
    const Shaft& at = shafts_[i];
    const double home = at.scale.home_counts * (2 * std::numbers::pi / at.scale.counts_per_revolution);
    at.bus->touch(at.axis, touches ? TouchProbeEdge::FirstRising : TouchProbeEdge::FirstFalling,
                  home + at.scale.direction * angles[i]);
  }
}

void TouchProbeModel::follow_switch() noexcept {
  if (probe_.switch_rpm == 0 || !spindle_) return;
  const double rpm = std::abs(spindle_->bus->spindle(spindle_->axis).speed_rpm());
  if (rpm > probe_.switch_rpm) spun_ = true;
  if (spun_ && rpm < probe_.switch_rpm / 10) {
    spun_ = false;
    powered_ = !powered_;
  }
}

// While the contact bounces, what a look finds is chance.
bool TouchProbeModel::contact(bool closed) noexcept {
  if (closed != closed_) bounces_s_ = probe_.bounce_s;
  const bool first = closed && !closed_;
  closed_ = closed;
  if (first || bounces_s_ <= 0) return closed;
  bounces_s_ -= period_s_;
  noise_ ^= noise_ << 13;
  noise_ ^= noise_ >> 17;
  noise_ ^= noise_ << 5;
  return (noise_ & 1U) != 0;
}

bool TouchProbeModel::exchange(std::uint64_t outputs, std::uint64_t& inputs) noexcept {
  const Instant now = look();
  follow_switch();
  if (!io_->exchange(outputs, inputs)) return false;
  const bool came = before_ && before_->distance > 0 && now.distance <= 0;
  on_for_s_ = came ? (1 - change_of_contact(*before_, now)) * period_s_ : 0;
  if (powered_ && contact(now.distance <= 0)) inputs |= mask(probe_.touch_input);
  if (powered_) inputs |= mask(probe_.ready_input);
  if (before_) touch_drives(*before_, now);
  before_ = now;
  return true;
}

double TouchProbeModel::on_for_s(std::size_t bit) const noexcept {
  return static_cast<int>(bit) == probe_.touch_input ? on_for_s_ : 0;
}

}  // namespace rmac::gateway
