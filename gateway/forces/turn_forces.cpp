#include "gateway/forces/turn_forces.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "gateway/forces/edge_forces.hpp"

namespace rmac::gateway {
namespace {

using std::numbers::pi;

/// A cut is as deep as the flutes are long where it is no more than this beyond them.
constexpr double kSlack_mm = 1e-6;

std::optional<std::string> problem(const EndMill& mill, std::span<const EngagedSlice> slices, const ToothFeed& feed,
                                   double spindle_rpm) {
  if (!(spindle_rpm > 0)) return "the spindle stands: without its speed there is no feed per tooth";
  const double most = mill.radius_mm();
  if (!(feed.across_mm >= 0 && feed.across_mm <= most && std::abs(feed.along_mm) <= most)) {
    return fmt::format(
        "the feed per tooth is {:g} mm across and {:g} mm along the tool's axis; allowed is 0 to its radius, {:g} mm: "
        "is the feed in mm/s, and the spindle's speed in rpm?",
        feed.across_mm, feed.along_mm, most);
  }
  for (const EngagedSlice& slice : slices) {
    if (slice.to_mm <= mill.cutting_length_mm() + kSlack_mm) continue;
    return fmt::format("the cut is {:g} mm deep, and the tool cuts up to LCF, {:g} mm", slice.to_mm,
                       mill.cutting_length_mm());
  }
  return std::nullopt;
}

void look(OverTurn& over, double value) {
  if (std::abs(value) > std::abs(over.peak)) over.peak = value;
}

}  // namespace

Expected<TurnForces> forces_over_turn(const EndMill& mill, const ForceCoefficients& material,
                                      std::span<const EngagedSlice> slices, const ToothFeed& feed, double spindle_rpm) {
  if (auto wrong = problem(mill, slices, feed, spindle_rpm)) {
    return failure(MinorCode::InvalidParameterValue, std::move(*wrong));
  }
  constexpr double kMillimetres = 1e3;
  const double per_second = 2 * pi * spindle_rpm / 60;
  const EdgeForces model(mill, material, slices, feed);
  TurnForces forces;
  const EdgeSum mean = model.mean();
  forces.tangential_n.mean = mean.tangential;
  forces.x_n.mean = mean.force[0], forces.y_n.mean = mean.force[1], forces.z_n.mean = mean.force[2];
  forces.total_n.mean = mean.force.norm();
  forces.torque_nm.mean = mean.torque / kMillimetres;
  for (const double angle : model.positions()) {
    const EdgeSum now = model.at(angle);
    look(forces.tangential_n, now.tangential);
    look(forces.x_n, now.force[0]), look(forces.y_n, now.force[1]), look(forces.z_n, now.force[2]);
    look(forces.total_n, now.force.norm());
    look(forces.torque_nm, now.torque / kMillimetres);
  }
  forces.power_w = {forces.torque_nm.mean * per_second, forces.torque_nm.peak * per_second};
  return forces;
}

Expected<ChipStiffness> chip_stiffness(const EndMill& mill, const ForceCoefficients& material,
                                       std::span<const EngagedSlice> slices, const ToothFeed& feed, int positions) {
  constexpr double kAnySpeed_rpm = 1;
  if (auto wrong = problem(mill, slices, feed, kAnySpeed_rpm)) {
    return failure(MinorCode::InvalidParameterValue, std::move(*wrong));
  }
  const ForceCoefficients of_chips{.ktc = material.ktc, .krc = material.krc, .kac = material.kac};
  const EdgeForces edges(mill, of_chips, slices, feed);
  ChipStiffness stiffness{.mean = edges.mean_change(), .over_pitch = {}};
  stiffness.over_pitch.reserve(static_cast<std::size_t>(positions));
  for (int i = 0; i < positions; ++i) {
    stiffness.over_pitch.push_back(edges.change_at(2 * pi / mill.teeth() * (i + 0.5) / positions));
  }
  return stiffness;
}

double removal_rate_mm3_s(const EndMill& mill, std::span<const EngagedSlice> slices, const ToothFeed& feed,
                          double spindle_rpm) {
  return EdgeForces(mill, {}, slices, feed).chip_mm3() * spindle_rpm / 60;
}

}  // namespace rmac::gateway
