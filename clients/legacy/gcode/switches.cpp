#include "clients/legacy/gcode/switches.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rmac::gcode {

namespace {

constexpr double kMostRpm = 1e6;
constexpr int kMostTool = 9999;

}  // namespace

void Switches::set_speed(const Word& word) {
  if (word.value < 0 || word.value > kMostRpm)
    refuse(word.place, "S is 0 to 1 000 000 turns a minute; M4 turns the other way");
  machine_.set_speed(word.value);
  speed_is_set_ = true;
}

void Switches::select_tool(const Word& word) {
  if (word.value != std::round(word.value) || word.value < 0 || word.value > kMostTool) {
    refuse(word.place, fmt::format("T is a tool's number, 0 to {}", kMostTool));
  }
  selected_ = static_cast<int>(word.value);
}

void Switches::change_tool(std::size_t place) {
  if (!selected_) refuse(place, "M6 without a T before it: to which tool?");
  outputs_off();
  tool_ = selected_;
  writer_.change_tool(*tool_);
  machine_.tool_was_changed();
}

void Switches::turn_spindle(int code) {
  machine_.turn(code == 3 ? 1 : code == 4 ? -1 : 0);
}

void Switches::switch_coolant(const Block& block) {
  if (block.m(MGroup::CoolantOff)) {
    machine_.set_mist(false);
    machine_.set_flood(false);
  }
  if (block.m(MGroup::Mist)) machine_.set_mist(true);
  if (block.m(MGroup::Flood)) machine_.set_flood(true);
}

void Switches::switch_output(const std::string& name, bool on) {
  const bool changes = on ? outputs_on_.insert(name).second : outputs_on_.erase(name) > 0;
  if (changes) writer_.output(name, on);
}

void Switches::outputs_off() {
  for (const std::string& name : outputs_on_) writer_.output(name, false);
  outputs_on_.clear();
}

void Switches::stop_coolant() {
  outputs_off();
  machine_.set_mist(false);
  machine_.set_flood(false);
  machine_.write();
}

void Switches::off() {
  outputs_off();
  machine_.off();
}

void Switches::restore(const State& saved) {
  machine_.set_speed(saved.rpm);
  speed_is_set_ = saved.speed_is_set;
  machine_.turn(saved.direction);
  machine_.set_mist(saved.mist);
  machine_.set_flood(saved.flood);
  machine_.write();
}

}  // namespace rmac::gcode
