#include "clients/legacy/apt/switches.hpp"

#include <fmt/format.h>

#include <optional>
#include <string>

namespace rmac::apt {

namespace {

constexpr double kMostRpm = 1e6;

}  // namespace

void Switches::set_spindle(Arguments& arguments) {
  if (arguments.take("OFF")) {
    arguments.end();
    machine_.turn(0);
    return machine_.write();
  }
  std::optional<double> rpm;
  if (arguments.done()) refuse(arguments.place(), "SPINDL lacks its turns a minute, ON or OFF");
  static_cast<void>(arguments.take("ON"));
  while (!arguments.done()) {
    if (arguments.has_number()) {
      if (rpm) refuse(arguments.next_place(), "SPINDL with two numbers: which are its turns a minute?");
      rpm = arguments.number("turns a minute");
      if (!(*rpm >= 0 && *rpm <= kMostRpm))
        refuse(arguments.last_place(), "SPINDL is 0 to 1 000 000 turns a minute; CCLW turns the other way");
      continue;
    }
    const std::string& word = arguments.word("turns a minute");
    if (word == "CLW") {
      way_ = 1;
    } else if (word == "CCLW") {
      way_ = -1;
    } else if (word != "RPM") {
      refuse(arguments.last_place(),
             fmt::format("SPINDL: {} is not taken; the spindle turns by RPM, CLW or CCLW", word));
    }
  }
  if (rpm) machine_.set_speed(*rpm);
  if (way_ == 0) refuse(arguments.place(), "which way the spindle turns was not said; write CLW or CCLW");
  machine_.turn(way_);
  if (machine_.rpm() == 0 && !rpm) refuse(arguments.place(), "how fast the spindle turns was not said");
  machine_.write();
}

void Switches::set_coolant(Arguments& arguments) {
  const std::string& word = arguments.word("ON, FLOOD, MIST or OFF");
  if (word == "OFF") {
    machine_.set_flood(false);
    machine_.set_mist(false);
  } else if (word == "ON" || word == "FLOOD") {
    machine_.set_flood(true);
  } else if (word == "MIST") {
    machine_.set_mist(true);
  } else {
    refuse(arguments.last_place(), fmt::format("COOLNT/{} is not taken; there are ON, FLOOD, MIST and OFF", word));
  }
  arguments.end();
  machine_.write();
}

}  // namespace rmac::apt
