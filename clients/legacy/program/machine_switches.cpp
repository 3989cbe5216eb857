#include "clients/legacy/program/machine_switches.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace rmac::legacy {

namespace {

void add(std::string& calls, const std::string& call) {
  if (!calls.empty()) calls += ',';
  calls += call;
}

}  // namespace

void MachineSwitches::tool_was_changed() noexcept {
  direction_ = 0;
  turning_rpm_ = 0;
  mist_on_ = flood_on_ = false;
}

void MachineSwitches::hold_spindle() {
  held_ = std::exchange(direction_, 0);
  write();
}

void MachineSwitches::release_spindle() {
  direction_ = std::exchange(held_, 0);
  write();
}

void MachineSwitches::write() {
  const double rpm = rpm_ * direction_;
  if (rpm == turning_rpm_ && flood_ == flood_on_ && mist_ == mist_on_) return;
  std::string calls;
  if (rpm != turning_rpm_) {
    add(calls,
        fmt::format(R"({{"method":"RMAC_CAM.SetSpindleRPM","params":{{"SpindleNumber":0,"RPM":{}}}}})", rpm + 0.0));
  }
  if (flood_ != flood_on_) {
    add(calls, flood_ ? R"({"method":"RMAC_CAM.TurnCoolantOn"})" : R"({"method":"RMAC_CAM.TurnCoolantOff"})");
  }
  if (mist_ != mist_on_) {
    add(calls, fmt::format(R"({{"method":"RMAC_CAM.SetOutput","params":{{"Name":"Mist","On":{}}}}})", mist_));
  }
  turning_rpm_ = rpm;
  flood_on_ = flood_;
  mist_on_ = mist_;
  writer_.in_turn(calls);
}

void MachineSwitches::off() {
  direction_ = 0;
  mist_ = flood_ = false;
  write();
}

}  // namespace rmac::legacy
