#include "servo/joints/measured_efforts.hpp"

#include <algorithm>
#include <bit>

#include "servo/joints/effort_matrix.hpp"

namespace rmac {

namespace {

IndexSet silent_actuators(std::span<const ServoActuator> actuators) {
  IndexSet silent = 0;
  for (std::size_t i = 0; i < actuators.size(); ++i) {
    if (!actuators[i].bus->interface->tells_torque(actuators[i].axis)) silent |= only(i);
  }
  return silent;
}

}  // namespace

MeasuredEfforts::MeasuredEfforts(const ActuatorMap& map, const Wiring& wiring, std::span<const ServoActuator> actuators)
    : map_(map), wiring_(wiring), actuators_(actuators) {
  find_groups();
  const IndexSet deaf = wiring_.joints_of(silent_actuators(actuators_));
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (wiring_.actuators_of(j) != 0 && (group_of_[j] & deaf) == 0) told_ |= only(j);
  }
}

void MeasuredEfforts::find_groups() noexcept {
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    IndexSet group = only(j), before = 0;
    while (group != before) {
      before = group;
      for (std::size_t k = 0; k < wiring_.joints(); ++k) {
        if (has(before, k)) group |= wiring_.joints_of(wiring_.actuators_of(k));
      }
    }
    group_of_[j] = group;
    place_[j] = static_cast<std::uint8_t>(std::popcount(group & first(j)));
    largest_group_ = std::max<std::size_t>(largest_group_, place_[j] + std::size_t{1});
  }
}

void MeasuredEfforts::read(std::span<const double> joints) noexcept {
  if (told_ == 0) return;
  for (std::size_t place = 0; place < largest_group_; ++place) {
    std::array<double, kMaxJoints> unit{};
    for (std::size_t j = 0; j < wiring_.joints(); ++j) unit[j] = place_[j] == place ? 1 : 0;
    map_.actuator_efforts(joints, {unit.data(), wiring_.joints()}, {torque_of_[place].data(), wiring_.actuators()});
  }
  std::array<double, kMaxJoints> torques{};
  for (std::size_t i = 0; i < actuators_.size(); ++i) {
    const ServoActuator& actuator = actuators_[i];
    torques[i] = shaft_nm(actuator.scale, actuator.bus->feedback[actuator.axis].torque_permille);
  }
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (told(j) && place_[j] == 0) read_group(group_of_[j], torques);
  }
}

// The efforts whose torques are nearest to those measured; with a joint alone the quotient of two sums.
void MeasuredEfforts::read_group(IndexSet joints, std::span<const double> torques) noexcept {
  if (std::has_single_bit(joints)) {
    const auto joint = static_cast<std::size_t>(std::countr_zero(joints));
    double along = 0, squared = 0;
    for (IndexSet left = wiring_.actuators_of(joint); left != 0; left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      along += torque_of_[0][i] * torques[i];
      squared += torque_of_[0][i] * torque_of_[0][i];
    }
    effort_[joint] = squared > 0 ? along / squared : 0;
    return;
  }
  EffortMatrix matrix = EffortMatrix::Zero(static_cast<Eigen::Index>(wiring_.actuators()), std::popcount(joints));
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (!has(joints, j)) continue;
    for (std::size_t i = 0; i < wiring_.actuators(); ++i) {
      if (has(wiring_.actuators_of(j), i)) matrix(static_cast<Eigen::Index>(i), place_[j]) = torque_of_[place_[j]][i];
    }
  }
  const Eigen::Map<const EffortVector> right(torques.data(), matrix.rows());
  const EffortVector solved = matrix.colPivHouseholderQr().solve(right);
  for (std::size_t j = 0; j < wiring_.joints(); ++j) {
    if (has(joints, j)) effort_[j] = solved[place_[j]];
  }
}

}  // namespace rmac
