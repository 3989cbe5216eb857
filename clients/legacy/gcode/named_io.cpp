#include "clients/legacy/gcode/named_io.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rmac::gcode {

namespace {

constexpr double kLongest_s = 3600;
constexpr int kOn = 3, kOff = 4;

const std::string& name_by_number(const Word& word, const std::map<int, std::string>& names, std::string_view kind) {
  const bool integer = word.value == std::round(word.value) && std::abs(word.value) < 1e6;
  const auto found = integer ? names.find(static_cast<int>(word.value)) : names.end();
  if (found != names.end()) return found->second;
  refuse(word.place, fmt::format("{0} {1:g} has a name here (DigitalIOInterface of device.json); give --{0} {1:g}=NAME",
                                 kind, word.value));
}

void await(Block& block, std::size_t place, const Options& options, Writer& writer) {
  const Word* input = block.find('P');
  if (input == nullptr) refuse(place, "M66 needs P, the number of a digital input; the appliance has no analogue ones");
  const Word* mode = block.find('L');
  if (mode == nullptr || (mode->value != kOn && mode->value != kOff)) {
    refuse(mode == nullptr ? place : mode->place,
           "M66 is taken with L3 and L4, which wait until the input is on, or off");
  }
  const Word* time_out = block.find('Q');
  if (time_out == nullptr || !(time_out->value > 0 && time_out->value <= kLongest_s)) {
    refuse(time_out == nullptr ? place : time_out->place, "M66 needs Q, how long it waits at most: to 3600 seconds");
  }
  writer.await_input(name_by_number(*input, options.inputs, "input"), mode->value == kOn, time_out->value);
}

}  // namespace

void act_on_names(Block& block, const Options& options, Writer& writer) {
  const auto& code = block.m(MGroup::Io);
  if (!code) return;
  if (code->number == 66) return await(block, code->place, options, writer);
  const Word* output = block.find('P');
  if (output == nullptr) refuse(code->place, fmt::format("M{} needs P, the number of an output", code->number));
  writer.output(name_by_number(*output, options.outputs, "output"), code->number == 62 || code->number == 64);
}

}  // namespace rmac::gcode
