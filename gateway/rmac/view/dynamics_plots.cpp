#include "gateway/rmac/view/dynamics_plots.hpp"

#include <fmt/format.h>

#include <span>
#include <utility>

namespace rmac::cli {
namespace {

constexpr int kErrorDigits = 6, kShareDigits = 4;

}  // namespace

DynamicsPlots::DynamicsPlots(gateway::AxisDynamics& axes, PlotTracks& plots) : axes_(axes), plots_(plots) {
  PlotTracks::Kind path{
      .row = "off the path", .name = "off the path", .unit = "mm", .tolerance = kWithin, .digits = kErrorDigits};
  if (const double allowed_mm = axes.deviation().allowed_mm(); allowed_mm > 0) {
    path.levels.push_back({"PositioningTolerance", allowed_mm});
  }
  const std::size_t tip = plots.start(std::move(path));
  axes.on_deviation([&plots, tip](double t_s, double off_mm) { plots.add(tip, t_s, off_mm); });
  start_motors();
  start_joints();
}

void DynamicsPlots::start_motors() {
  for (const gateway::MotorTorque& motor : axes_.motor_torques()) {
    // A drive tells its torque as a share of what it is rated for, so that there is none without.
    const double rated_nm = motor.rated_nm > 0 ? motor.rated_nm : 1;
    PlotTracks::Kind kind{.row = "motors",
                          .name = fmt::format("{} {}", motor.bus, motor.axis),
                          .unit = "of rated",
                          .tolerance = kWithinOfRated,
                          .digits = kShareDigits,
                          .levels = {{"rated", 1}},
                          .most_keys = kMostKeys};
    if (motor.allowed_nm > 0) kind.levels.push_back({"allowed", motor.allowed_nm / rated_nm});
    const std::size_t plot = plots_.start(std::move(kind));
    if (rated_nm_.empty()) first_motor_ = plot;
    rated_nm_.push_back(rated_nm);
  }
}

void DynamicsPlots::start_joints() {
  bool first = true;
  for (const gateway::JointDeviation& joint : axes_.joint_deviations()) {
    const std::size_t plot = plots_.start({.row = "joints off",
                                           .name = joint.name,
                                           .unit = joint.rotary ? "°" : "mm",
                                           .tolerance = kWithin,
                                           .digits = kErrorDigits,
                                           .most_keys = kMostKeys});
    if (std::exchange(first, false)) first_joint_ = plot;
  }
}

void DynamicsPlots::cycle(const gateway::CycleSample& planned) {
  if (over_) return;
  over_ = axes_.stopped().has_value();
  for (std::size_t i = 0; i < rated_nm_.size(); ++i) {
    plots_.add(first_motor_ + i, planned.t_s, axes_.torque_nm(i) / rated_nm_[i]);
  }
  const std::span<const double> joints = axes_.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    plots_.add(first_joint_ + j, planned.t_s, joints[j] - planned.position_set[j]);
  }
}

}  // namespace rmac::cli
