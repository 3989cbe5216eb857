#include "clients/legacy/fanuc/system_variables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc {

namespace {

constexpr int kAlarm = 3000, kMessageStop = 3006, kInMachine = 5021;

struct Range {
  int first = 0, last = 0;
  std::string_view what;
  std::string_view begin = "one of those that are";
};

// Of numbers that are not known here, what they are.
constexpr auto kRanges = std::to_array<Range>({
    {1000, 1199, "signals between a control and its machine, which are not known here"},
    {2000, 2999, "tool offsets; those are in the appliance's tool table (rmac tools), and not known here"},
    {3000, 3000, "an alarm, which is only set"},
    {3001, 3002, "clocks of a control, which are not known here"},
    {3003, 3004, "the operator's overrides, hold and single blocks, which no program takes away"},
    {3005, 3999, "settings and clocks of a control, which are not known here"},
    {4000, 4999, "codes that were in force, of which this one is not known here"},
    {5001, 5060, "places of the tool, of which this one is not known here"},
    {5061, 5080, gcode::kProbing, "what the last G31 found:"},
    {5081, 5199, "places of the tool, of which this one is not known here"},
    {5200, 5999, "work offsets; set them by G10 L2"},
    {7000, 7999, "work offsets; set them by G10 L20"},
    {10000, 19999, "tool offsets; those are in the appliance's tool table (rmac tools), and not known here"},
});

[[noreturn]] void refuse_of_system(int number, std::size_t place) {
  const auto* found = std::ranges::find_if(
      kRanges, [number](const Range& range) { return number >= range.first && number <= range.last; });
  if (found == kRanges.end()) refuse(place, fmt::format("#{} is a variable of the system, and not known here", number));
  refuse(place, fmt::format("#{} is {} {}", number, found->begin, found->what));
}

}  // namespace

gcode::Maybe SystemVariables::code_in_force(int number) const {
  const gcode::Modes& modes = interpreter_.modes();
  constexpr int kLastInterpolation = 30;
  const auto code = [](int tenfold) { return gcode::Maybe(tenfold / 10); };
  switch (number) {
    case 4001:
      return modes.interpolation > kLastInterpolation ? std::nullopt : code(modes.interpolation);
    case 4002:
      return modes.plane.normal == 2 ? 17 : modes.plane.normal == 1 ? 18 : 19;
    case 4003:
      return modes.incremental ? 91 : 90;
    case 4005:
      return modes.inverse_time ? 93 : 94;
    case 4006:
      return modes.unit_mm ? gcode::Maybe(*modes.unit_mm == 1 ? 21 : 20) : std::nullopt;
    case 4009:
      return modes.motion > kLastInterpolation ? code(modes.motion) : gcode::Maybe(80);
    case 4010:
      return modes.retract_to_r ? 99 : 98;
    case 4014: {
      constexpr std::size_t kSystems = 6, kFirst = 54;
      const std::size_t system = interpreter_.coordinates().active();
      if (system < kSystems) return static_cast<double>(kFirst + system);
      return rules_.further_in_force == 0 ? std::nullopt : gcode::Maybe(rules_.further_in_force);
    }
    case 4109:
      if (modes.inverse_time || !modes.unit_mm) return std::nullopt;
      return modes.feed_mm_min / *modes.unit_mm;
    case 4114:
      return flow_.last_label();
    case 4115:
      return flow_.program() == FanucProgram::kUnnumbered ? std::nullopt : gcode::Maybe(flow_.program());
    case 4119:
      return interpreter_.switches().rpm();
    case 4120:
      return interpreter_.switches().selected();
    default:
      return std::nullopt;
  }
}

gcode::Maybe SystemVariables::tip(std::size_t axis, int number, std::size_t place) const {
  interpreter_.require_no_contour(place);
  if (axis != 2) interpreter_.doubts().require_none(place);
  if (interpreter_.coordinates().placement())
    refuse(place, fmt::format("#{} is where the tool is, and in turned, tilted or mirrored coordinates controls do not "
                              "mean the same by it; write G69, or G50.1, before it",
                              number));
  if (const auto tip = interpreter_.tip(axis)) return tip;
  refuse(place,
         fmt::format("#{} is where the tool is, which is not known here; write a G0 to X, Y and Z before it", number));
}

gcode::Maybe SystemVariables::machine_tip(std::size_t axis, int number, std::size_t place) const {
  static_cast<void>(tip(axis, number, place));
  if (axis == 2)
    refuse(place, fmt::format("#{} is where the spindle is without its tool, whose length is not known here; write the "
                              "value instead",
                              number));
  if (const auto mm = interpreter_.coordinates().machine_tip(axis)) return *mm / interpreter_.modes().unit(place);
  refuse(place, fmt::format("#{0} is where the tool is in the machine, and where {1} is in it is not known here; give "
                            "--offset {1}=X,Y,Z",
                            number, rules_.system_name(interpreter_.coordinates().active()).name));
}

gcode::Maybe SystemVariables::read(int number, std::size_t place) const {
  for (const int first : {5001, 5021, 5041}) {
    if (number < first || number > first + 2) continue;
    const auto axis = static_cast<std::size_t>(number - first);
    return first == kInMachine ? machine_tip(axis, number, place) : tip(axis, number, place);
  }
  if (const auto value = code_in_force(number)) return value;
  refuse_of_system(number, place);
}

void SystemVariables::write(int number, gcode::Maybe value, std::string_view message, std::size_t place) {
  constexpr int kFirstAlarm = 3000;
  if (number == kAlarm) {
    refuse(place, fmt::format("the program raises its alarm {:g} here{}{}", kFirstAlarm + value.value_or(0),
                              message.empty() ? "" : ": ", message));
  }
  if (number != kMessageStop) refuse_of_system(number, place);
  interpreter_.require_no_contour(place);
  interpreter_.stop(false, message);
}

}  // namespace rmac::fanuc
