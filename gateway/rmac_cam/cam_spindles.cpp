#include "gateway/rmac_cam/cam_spindles.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::gateway {

void CamSpindles::mechanism_changed() {
  max_rpm_.clear();
  for (const sdk::Spindle& spindle : device_.get_or_empty().spindles) max_rpm_.push_back(spindle.max_speed_rpm);
}

Expected<std::size_t> CamSpindles::check_rpm(const char* function, int spindle, double rpm) const {
  auto found = device_.find_spindle(spindle, function);
  if (!found) return found;
  if (!std::isfinite(rpm)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: the speed must be finite", function));
  }
  if (const double max = max_rpm_[*found]; std::abs(rpm) > max) {
    return failure(MinorCode::SpeedLimit,
                   fmt::format("{}: {} rpm is above spindle {}'s maximum of {} rpm", function, rpm, spindle, max));
  }
  return found;
}

Expected<> CamSpindles::set_rpm(int spindle, double rpm) {
  const auto found = check_rpm("SetSpindleRPM", spindle, rpm);
  if (!found) return tl::unexpected(found.error());
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
  return switch_output(function, bit, on);
}

Expected<> CamSpindles::set_output(const std::string& name, bool on) {
  const auto bit = device_.find_output(name, "SetOutput");
  if (!bit) return tl::unexpected(bit.error());
  if (auto not_changers = check_not_the_changers("SetOutput", name); !not_changers) return not_changers;
  // What an operator holds may be held by a clamp: nothing is switched, on or off, but by them.
  if (auto free = supervisor_.operating().require_free("SetOutput"); !free) return free;
  return switch_output("SetOutput", *bit, on);
}

Expected<> CamSpindles::switch_output(const char* function, std::uint64_t bit, bool on) {
  if (on && is_faulted(supervisor_.state())) {
    return failure(MinorCode::Other, fmt::format("{}: the machine is faulted; remove the cause, then reset", function));
  }
  if (on) {
    if (auto free = supervisor_.operating().require_free(function); !free) return free;
  }
  if (on && supervisor_.tools_now().changing) {
    return failure(MinorCode::Other, fmt::format("{}: a tool change is under way; wait for its end", function));
  }
  supervisor_.wish([&](ServoWishes& wishes) { wishes.outputs = on ? wishes.outputs | bit : wishes.outputs & ~bit; });
  return {};
}

Expected<> CamSpindles::check_not_the_changers(const char* function, const std::string& output) const {
  const bool the_changers = std::ranges::any_of(device_.get()->tool_change, [&](const sdk::ToolChangeStep& step) {
    return std::ranges::find(step.outputs, output) != step.outputs.end();
  });
  if (!the_changers) return {};
  return failure(MinorCode::UnsupportedOperation,
                 fmt::format("{}: the tool changer switches {}; change tools with DoToolChange", function, output));
}

Expected<Switch::Speed> CamSpindles::in_turn(const sdk::SpindleCall& call) const {
  const auto found = check_rpm("InTurn", call.spindle, call.rpm);
  if (!found) return tl::unexpected(found.error());
  return tools_.check_speed_in_turn(call.rpm).map([&] { return Switch::Speed{*found, call.rpm}; });
}

Expected<Switch::Output> CamSpindles::in_turn(const sdk::OutputCall& call) const {
  const auto bit = device_.find_output(call.name, "InTurn");
  if (!bit) return tl::unexpected(bit.error());
  if (auto not_changers = check_not_the_changers("InTurn", call.name); !not_changers)
    return tl::unexpected(not_changers.error());
  return Switch::Output{call.name, call.on, *bit};
}

}  // namespace rmac::gateway
