#include "gateway/rmac_cam/settings/cam_path_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

constexpr double kSecondsPerMinute = 60;

tl::unexpected<Error> refuse(std::string message) {
  return failure(MinorCode::InvalidParameterValue, std::move(message));
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

}  // namespace

Expected<> check_acceleration(const char* function, double value, double bound) {
  if (!positive(value)) return refuse(fmt::format("{}: {} mm/s² must be above 0", function, value));
  if (bound > 0 && value > bound) {
    return failure(MinorCode::AccelerationLimit,
                   fmt::format("{}: {} mm/s² is above the mechanism's {} mm/s²", function, value, bound));
  }
  return {};
}

void CamPathSettings::mechanism_changed(bool fresh) {
  const sdk::DeviceObject& now = device_.get_or_empty();
  if (fresh) {
    values_ = {};
    values_.accel_rise_mm_s2 = now.path_accel_rise_mm_s2;
    values_.accel_fall_mm_s2 = now.path_accel_fall_mm_s2;
  }
  values_.max_feedrate_mm_min = now.max_feedrate_mm_min;
}

Expected<> CamPathSettings::set_feedrate(double mm_min) {
  if (auto loaded = device_.require("SetFeedrate"); !loaded) return loaded;
  if (!positive(mm_min)) return refuse(fmt::format("SetFeedrate: {} mm/min must be above 0", mm_min));
  if (mm_min > values_.max_feedrate_mm_min) {
    return failure(MinorCode::SpeedLimit, fmt::format("SetFeedrate: {} mm/min is above the maximum of {} mm/min",
                                                      mm_min, values_.max_feedrate_mm_min));
  }
  values_.feedrate_mm_min = mm_min;
  return {};
}

double CamPathSettings::feedrate() const {
  return history_.latest().feed_actual_mm_s * kSecondsPerMinute;
}

Expected<> CamPathSettings::set_max_feedrate(double mm_min) {
  if (auto loaded = device_.require("SetMaxFeedrate"); !loaded) return loaded;
  if (!positive(mm_min)) return refuse(fmt::format("SetMaxFeedrate: {} mm/min must be above 0", mm_min));
  const double bound = device_.get()->max_feedrate_mm_min;
  if (mm_min > bound) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetMaxFeedrate: {} mm/min is above the mechanism's {} mm/min, which RMAC_CAM can only "
                               "tighten",
                               mm_min, bound));
  }
  values_.max_feedrate_mm_min = mm_min;
  return {};
}

Expected<> CamPathSettings::set_accel_rise(double mm_s2) {
  constexpr const char* kFunction = "SetPathAccelRise";
  return device_.require(kFunction)
      .and_then([&] { return check_acceleration(kFunction, mm_s2, device_.get()->path_accel_rise_mm_s2); })
      .map([&] { values_.accel_rise_mm_s2 = mm_s2; });
}

Expected<> CamPathSettings::set_accel_fall(double mm_s2) {
  constexpr const char* kFunction = "SetPathAccelFall";
  return device_.require(kFunction)
      .and_then([&] { return check_acceleration(kFunction, mm_s2, device_.get()->path_accel_fall_mm_s2); })
      .map([&] { values_.accel_fall_mm_s2 = mm_s2; });
}

Expected<> CamPathSettings::set_tolerance(double mm) {
  if (!std::isfinite(mm) || mm < 0) return refuse(fmt::format("SetPathTolerance: {} mm must be 0 or more", mm));
  values_.tolerance_mm = mm;
  return {};
}

Expected<> CamPathSettings::set_orientation_tolerance(double degrees) {
  if (!std::isfinite(degrees) || degrees < 0)
    return refuse(fmt::format("SetOrientationTolerance: {} degrees must be 0 or more", degrees));
  values_.orientation_tolerance_deg = degrees;
  return {};
}

Expected<> CamPathSettings::check_feed(std::int64_t move_id) const {
  if (!(values_.feedrate_mm_min > 0)) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("move {}: no feed is set; use SetFeedrate before the first move", move_id));
  }
  // The maximum may have been lowered since the feed was set.
  if (values_.feedrate_mm_min > values_.max_feedrate_mm_min) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("move {}: the feed in force, {} mm/min, is above the maximum of {} mm/min; set a lower "
                               "one with SetFeedrate",
                               move_id, values_.feedrate_mm_min, values_.max_feedrate_mm_min));
  }
  return {};
}

double CamPathSettings::feed_mm_s() const noexcept {
  return values_.feedrate_mm_min / kSecondsPerMinute;
}

double CamPathSettings::max_feed_mm_s() const noexcept {
  return values_.max_feedrate_mm_min / kSecondsPerMinute;
}

void CamPathSettings::take_up(const Values& values) {
  values_ = values;
  values_.max_feedrate_mm_min = std::min(values_.max_feedrate_mm_min, device_.get_or_empty().max_feedrate_mm_min);
}

}  // namespace rmac::gateway
