#include "clients/legacy/rs274/switches.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace rmac::rs274 {

namespace {

constexpr double kMostRpm = 1e6;
constexpr int kMostTool = 9999;

void add(std::string& calls, const std::string& call) {
  if (!calls.empty()) calls += ',';
  calls += call;
}

}  // namespace

void Switches::set_speed(const Word& word) {
  if (word.value < 0 || word.value > kMostRpm)
    refuse(word.place, "S is 0 to 1 000 000 turns a minute; M4 turns the other way");
  rpm_ = word.value;
}

void Switches::select_tool(const Word& word) {
  if (word.value != std::round(word.value) || word.value < 0 || word.value > kMostTool) {
    refuse(word.place, fmt::format("T is a tool's number, 0 to {}", kMostTool));
  }
  selected_ = static_cast<int>(word.value);
}

void Switches::change_tool(std::size_t place) {
  if (!selected_) refuse(place, "M6 without a T before it: to which tool?");
  tool_ = selected_;
  writer_.change_tool(*tool_);
  direction_ = 0;
  turning_rpm_ = 0;
  mist_on_ = flood_on_ = false;
}

void Switches::turn_spindle(int code) {
  direction_ = code == 3 ? 1 : code == 4 ? -1 : 0;
}

void Switches::hold_spindle() {
  held_ = std::exchange(direction_, 0);
  write();
}

void Switches::release_spindle() {
  direction_ = std::exchange(held_, 0);
  write();
}

void Switches::switch_coolant(const Block& block) {
  if (block.m(MGroup::CoolantOff)) mist_ = flood_ = false;
  if (block.m(MGroup::Mist)) mist_ = true;
  if (block.m(MGroup::Flood)) flood_ = true;
}

void Switches::write() {
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

void Switches::off() {
  direction_ = 0;
  mist_ = flood_ = false;
  write();
}

}  // namespace rmac::rs274
