#include "gateway/rmac_cam/settings/cam_joint_settings.hpp"

#include <fmt/format.h>

#include <cmath>

#include "gateway/rmac_cam/settings/cam_path_settings.hpp"

namespace rmac::gateway {

void CamJointSettings::mechanism_changed(bool fresh) {
  if (fresh) values_.interp_percent = Values{}.interp_percent;
  values_.accel_rise.clear();
  for (const sdk::Joint& joint : device_.get_or_empty().joints) {
    values_.accel_rise.push_back(joint.limits.max_acceleration);
  }
  values_.accel_fall = values_.accel_rise;
}

Expected<> CamJointSettings::set_interp_speed(double percent) {
  if (!std::isfinite(percent) || !(percent > 0) || percent > 100) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("SetJointInterpSpeed: {} percent must be above 0 and at most 100", percent));
  }
  values_.interp_percent = percent;
  return {};
}

Expected<> CamJointSettings::set(std::vector<double>& accelerations, const char* function, int joint, double value) {
  const auto found = device_.find_joint(joint, function);
  if (!found) return tl::unexpected(found.error());
  return check_acceleration(function, value, device_.get()->joints[*found].limits.max_acceleration).map([&] {
    accelerations[*found] = value;
  });
}

Expected<> CamJointSettings::set_accel_rise(int joint, double value) {
  return set(values_.accel_rise, "SetJointAccelRise", joint, value);
}

Expected<double> CamJointSettings::accel_rise(int joint) const {
  return device_.find_joint(joint, "GetJointAccelRise").map([&](std::size_t found) {
    return values_.accel_rise[found];
  });
}

Expected<> CamJointSettings::set_accel_fall(int joint, double value) {
  return set(values_.accel_fall, "SetJointAccelFall", joint, value);
}

Expected<double> CamJointSettings::accel_fall(int joint) const {
  return device_.find_joint(joint, "GetJointAccelFall").map([&](std::size_t found) {
    return values_.accel_fall[found];
  });
}

}  // namespace rmac::gateway
