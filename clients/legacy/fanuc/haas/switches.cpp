#include "clients/legacy/fanuc/haas/switches.hpp"

#include <fmt/format.h>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc::haas {

void switch_on(const HaasWords& words, const gcode::Block& block, const gcode::Options& options,
               gcode::Interpreter& interpreter) {
  for (const auto& switched : words.switched) {
    if (!switched.on) continue;
    for (const auto group : {gcode::MGroup::Tool, gcode::MGroup::Stop}) {
      if (const auto& off = block.m(group))
        refuse(switched.place, fmt::format("M{0} beside M{1}, which switches it off; write M{0} in a block behind it",
                                           switched.number, off->number));
    }
    const auto output = options.outputs.find(switched.number);
    if (output == options.outputs.end())
      refuse(switched.place,
             fmt::format("which output of the machine is {1} is not known here; give --output {0}=NAME, "
                         "or --pass-over M{0} where the cut may go without",
                         switched.number, switched.what));
    interpreter.switch_output(output->second, true);
  }
}

void switch_off(const HaasWords& words, const gcode::Options& options, gcode::Interpreter& interpreter) {
  for (const auto& switched : words.switched) {
    const auto output = options.outputs.find(switched.number);
    if (!switched.on && output != options.outputs.end()) interpreter.switch_output(output->second, false);
  }
}

}  // namespace rmac::fanuc::haas
