#include "gateway/rmac_config/mechanism_editor.hpp"

#include <fmt/format.h>

#include <utility>

#include "gateway/json/range.hpp"
#include "rmac/motion/machine_size.hpp"

namespace rmac::gateway {
namespace {

/// `count` is any integer.
Expected<> check_count(const char* function, auto count, int least, std::size_t most) {
  if (std::cmp_greater_equal(count, least) && std::cmp_less_equal(count, most)) return {};
  return failure(MinorCode::InvalidParameterValue,
                 fmt::format("{}: {} must be {} to {}", function, count, least, most));
}

/// Makes them so many; those that come are as device.json describes them, as far as it does.
template <typename Part>
void resize(std::vector<Part>& parts, std::size_t count, const std::vector<Part>& described) {
  for (std::size_t i = parts.size(); i < count; ++i) parts.push_back(i < described.size() ? described[i] : Part{});
  parts.resize(count);
}

}  // namespace

Expected<> MechanismEditor::set_kinematics(const sdk::ModuleChoice& module) {
  return choose_module("SetMechanismKinematics", module, draft_.edit().kinematics);
}

Expected<> MechanismEditor::set_actuator_map(const sdk::ModuleChoice& module) {
  return choose_module("SetMechanismActuatorMap", module, draft_.edit().actuator_map);
}

Expected<> MechanismEditor::set_number_of_joints(int count) {
  const std::size_t most = kMaxJoints - draft_.device.held_joints.size();
  return check_count("SetMechanismNumJnts", count, 1, most).map([&] {
    resize(draft_.edit().joints, static_cast<std::size_t>(count), draft_.described);
  });
}

Expected<> MechanismEditor::set_number_of_spindles(int count) {
  return check_count("SetMechanismNumSpindle", count, 0, kMaxSpindles).map([&] {
    resize(draft_.edit().spindles, static_cast<std::size_t>(count), draft_.described_spindles);
  });
}

Expected<> MechanismEditor::set_number_of_actuators(int count) {
  return check_count("SetMechanismNumActuators", count, 1, kMaxJoints).map([&] {
    resize(draft_.edit().actuators, static_cast<std::size_t>(count), draft_.described_actuators);
  });
}

Expected<> MechanismEditor::set_actuators(std::span<const sdk::Actuator> actuators) {
  return check_count("SetMechanismNumActuators", actuators.size(), 1, kMaxJoints).map([&] {
    draft_.edit().actuators.assign(actuators.begin(), actuators.end());
  });
}

Expected<> MechanismEditor::set_spindles(std::span<const sdk::Spindle> spindles) {
  return check_count("SetMechanismNumSpindle", spindles.size(), 0, kMaxSpindles).map([&] {
    draft_.edit().spindles.assign(spindles.begin(), spindles.end());
  });
}

Expected<> MechanismEditor::set_maximum_feedrate(double mm_min) {
  return check_device_range("MaxFeedrate", mm_min, "SetMechanismMaxFeedrate").map([&] {
    draft_.edit().max_feedrate_mm_min = mm_min;
  });
}

}  // namespace rmac::gateway
