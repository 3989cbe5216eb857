#include <fmt/format.h>

#include <cmath>

#include "gateway/rmac_cam/cam.hpp"

namespace rmac::gateway {

Expected<std::size_t> Cam::find_spindle(int spindle, const char* function) const {
  if (auto loaded = require_mechanism(function); !loaded) return tl::unexpected(loaded.error());
  const std::size_t count = device_->spindles.size();
  if (spindle < 0 || static_cast<std::size_t>(spindle) >= count) {
    return failure(MinorCode::InvalidParameterValue,
                   count == 0
                       ? fmt::format("{}: the mechanism has no spindle", function)
                       : fmt::format("{}: there is no spindle {}; spindles are 0 to {}", function, spindle, count - 1));
  }
  return static_cast<std::size_t>(spindle);
}

Expected<> Cam::set_spindle_rpm(int spindle, double rpm) {
  const auto found = find_spindle(spindle, "SetSpindleRPM");
  if (!found) return tl::unexpected(found.error());
  if (!std::isfinite(rpm)) return failure(MinorCode::InvalidParameterValue, "SetSpindleRPM: the speed must be finite");
  if (const double max = settings_.spindle_max_rpm[*found]; std::abs(rpm) > max) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetSpindleRPM: {} rpm is above spindle {}'s maximum of {} rpm", rpm, spindle, max));
  }
  const CycleState state = supervisor_.state();
  if (rpm != 0 && (is_faulted(state))) {
    return failure(MinorCode::Other, "SetSpindleRPM: the machine is faulted; remove the cause, then reset");
  }
  return check_tool_speed(rpm).map([&] { supervisor_.set_spindle(*found, rpm); });
}

Expected<double> Cam::spindle_rpm(int spindle) const {
  return find_spindle(spindle, "GetSpindleRPM").map([&](std::size_t found) {
    return link_.history.latest().spindle_rpm[found];
  });
}

Expected<> Cam::set_spindle_max_rpm(int spindle, double rpm) {
  const auto found = find_spindle(spindle, "SetSpindleMaxRPM");
  if (!found) return tl::unexpected(found.error());
  const double bound = device_->spindles[*found].max_speed_rpm;
  if (!std::isfinite(rpm) || !(rpm > 0)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("SetSpindleMaxRPM: {} rpm must be above 0", rpm));
  }
  if (rpm > bound) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("SetSpindleMaxRPM: {} rpm is above the mechanism's {} rpm, which RMAC_CAM can only "
                               "tighten",
                               rpm, bound));
  }
  settings_.spindle_max_rpm[*found] = rpm;
  return {};
}

Expected<double> Cam::spindle_max_rpm(int spindle) const {
  return find_spindle(spindle, "GetSpindleMaxRPM").map([&](std::size_t found) {
    return settings_.spindle_max_rpm[found];
  });
}

Expected<> Cam::set_coolant(bool on) {
  const char* function = on ? "TurnCoolantOn" : "TurnCoolantOff";
  if (auto loaded = require_mechanism(function); !loaded) return loaded;
  const auto output = device_->outputs.find(kCoolantOutput);
  if (output == device_->outputs.end()) {
    return failure(MinorCode::UnsupportedOperation,
                   fmt::format("{}: {} has no output named {} in its DigitalIOInterface", function, device_->name,
                               kCoolantOutput));
  }
  if (on && supervisor_.tools_now().changing) {
    return failure(MinorCode::Other, "TurnCoolantOn: a tool change is under way; wait for its end");
  }
  const std::uint64_t bit = std::uint64_t{1} << output->second;
  supervisor_.wish([&](ServoWishes& wishes) { wishes.outputs = on ? wishes.outputs | bit : wishes.outputs & ~bit; });
  return {};
}

}  // namespace rmac::gateway
