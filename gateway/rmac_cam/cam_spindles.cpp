#include "gateway/rmac_cam/cam_spindles.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rmac::gateway {

void CamSpindles::mechanism_changed() {
  max_rpm_.clear();
  for (const sdk::Spindle& spindle : device_.get_or_empty().spindles) max_rpm_.push_back(spindle.max_speed_rpm);
}

Expected<> CamSpindles::set_rpm(int spindle, double rpm) {
  const auto found = device_.find_spindle(spindle, "SetSpindleRPM");
  if (!found) return tl::unexpected(found.error());
  if (!std::isfinite(rpm)) return failure(MinorCode::InvalidParameterValue, "SetSpindleRPM: the speed must be finite");
  if (const double max = max_rpm_[*found]; std::abs(rpm) > max) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetSpindleRPM: {} rpm is above spindle {}'s maximum of {} rpm", rpm, spindle, max));
  }
  if (rpm != 0 && is_faulted(supervisor_.state())) {
    return failure(MinorCode::Other, "SetSpindleRPM: the machine is faulted; remove the cause, then reset");
  }
  auto free = rpm == 0 ? Expected<>{} : supervisor_.operating().require_free("SetSpindleRPM");
  return free.and_then([&] { return tools_.check_speed(rpm); }).map([&] { supervisor_.set_spindle(*found, rpm); });
}

Expected<double> CamSpindles::rpm(int spindle) const {
  return device_.find_spindle(spindle, "GetSpindleRPM").map([&](std::size_t found) {
    return history_.latest().spindle_rpm[found];
  });
}

Expected<> CamSpindles::set_max_rpm(int spindle, double rpm) {
  const auto found = device_.find_spindle(spindle, "SetSpindleMaxRPM");
  if (!found) return tl::unexpected(found.error());
  const double bound = device_.get()->spindles[*found].max_speed_rpm;
  if (!std::isfinite(rpm) || !(rpm > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("SetSpindleMaxRPM: {} rpm must be above 0", rpm));
  }
  if (rpm > bound) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetSpindleMaxRPM: {} rpm is above the mechanism's {} rpm, which RMAC_CAM can only "
                               "tighten",
                               rpm, bound));
  }
  max_rpm_[*found] = rpm;
  return {};
}

Expected<double> CamSpindles::max_rpm(int spindle) const {
  return device_.find_spindle(spindle, "GetSpindleMaxRPM").map([&](std::size_t found) { return max_rpm_[found]; });
}

Expected<> CamSpindles::set_coolant(bool on) {
  const char* function = on ? "TurnCoolantOn" : "TurnCoolantOff";
  if (auto loaded = device_.require(function); !loaded) return loaded;
  const std::uint64_t bit = device_.coolant();
  if (bit == 0) {
    return failure(
        MinorCode::UnsupportedOperation,
        fmt::format("{}: {} has no output named Coolant in its DigitalIOInterface", function, device_.get()->name));
  }
  if (on && supervisor_.tools_now().changing) {
    return failure(MinorCode::Other, "TurnCoolantOn: a tool change is under way; wait for its end");
  }
  supervisor_.wish([&](ServoWishes& wishes) { wishes.outputs = on ? wishes.outputs | bit : wishes.outputs & ~bit; });
  return {};
}

}  // namespace rmac::gateway
