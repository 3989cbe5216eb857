#include "servo/joints/transmission.hpp"

#include <algorithm>
#include <array>

#include "servo/joints/effort_matrix.hpp"

namespace rmac {

Transmission::Transmission(const ActuatorMap& map, std::span<const ServoJoint> joints) : map_(map) {
  for (const ServoJoint& joint : joints) corrections_.emplace_back(joint.mechanics);
}

void Transmission::shafts_for(std::span<const double> joint_positions, std::span<double> shafts) const noexcept {
  std::array<double, kMaxJoints> shown{};
  for (std::size_t j = 0; j < corrections_.size(); ++j) shown[j] = corrections_[j].shown(joint_positions[j]);
  map_.actuator_positions({shown.data(), corrections_.size()}, shafts);
}

void Transmission::joints_for(std::span<const double> shafts, std::span<double> joint_positions) const noexcept {
  map_.joint_positions(shafts, joint_positions);
  for (std::size_t j = 0; j < corrections_.size(); ++j) {
    joint_positions[j] = corrections_[j].actual(joint_positions[j]);
  }
}

// The map's efforts are linear, so its unit responses are its matrix.
void Transmission::efforts_for(std::span<const double> joint_positions, std::span<const double> torques,
                               std::span<double> efforts) const noexcept {
  EffortMatrix matrix(torques.size(), efforts.size());
  for (std::size_t j = 0; j < efforts.size(); ++j) {
    std::array<double, kMaxJoints> unit{};
    unit[j] = 1;
    map_.actuator_efforts(joint_positions, {unit.data(), efforts.size()},
                          {&matrix(0, static_cast<Eigen::Index>(j)), torques.size()});
  }
  const Eigen::Map<const EffortVector> right(torques.data(), static_cast<Eigen::Index>(torques.size()));
  const EffortVector solved = matrix.colPivHouseholderQr().solve(right);
  std::copy_n(solved.data(), efforts.size(), efforts.data());
}

}  // namespace rmac
