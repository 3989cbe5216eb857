#include "clients/legacy/rs274/told.hpp"

#include "clients/legacy/rs274/blocks/control_names.hpp"

namespace rmac::rs274 {

namespace {

using Told = std::optional<double>;

/// Those of G92 and the work systems (5211 to 5383) are not known: the control keeps the former while G92.2 suspends
/// them, and the latter in the unit of the machine, which no program says.
Told by_number(const gcode::Interpreter& interpreter, int number) {
  if (number == 5220) return static_cast<double>(interpreter.coordinates().active() + 1);
  if (number == 5400) return interpreter.switches().tool();
  if (number < 5420 || number > 5422) return std::nullopt;
  return interpreter.tip(static_cast<std::size_t>(number - 5420));
}

Told in_unit(const gcode::Modes& modes, double mm) {
  return modes.unit_mm ? Told(mm / *modes.unit_mm) : std::nullopt;
}

double system_code(std::size_t index) {
  constexpr std::size_t kWhole = 6;  // G54 to G59; G59.1 to G59.3 behind them
  return static_cast<double>(index < kWhole ? 540 + 10 * index : 591 + index - kWhole);
}

Told of_modes(const gcode::Modes& modes, ControlName name) {
  const bool is_metric = modes.unit_mm == 1;
  switch (name) {
    case ControlName::Metric:
      return modes.unit_mm ? Told(is_metric) : std::nullopt;
    case ControlName::Imperial:
      return modes.unit_mm ? Told(!is_metric) : std::nullopt;
    case ControlName::Absolute:
      return !modes.incremental;
    case ControlName::Incremental:
      return modes.incremental;
    case ControlName::Plane:
      return modes.plane.normal == 2 ? 170 : modes.plane.normal == 1 ? 180 : 190;
    case ControlName::MotionMode:
      return modes.motion;
    case ControlName::ToolOffset:
      return modes.length == gcode::ToolLength::On;
    case ControlName::RetractToR:
      return modes.retract_to_r;
    case ControlName::RetractToOldZ:
      return !modes.retract_to_r;
    case ControlName::AbsoluteCentres:
      return modes.absolute_centres;
    case ControlName::Feed:
      return modes.inverse_time ? std::nullopt : in_unit(modes, modes.feed_mm_min);
    case ControlName::InverseTime:
      return modes.inverse_time;
    case ControlName::UnitsPerMinute:
      return !modes.inverse_time;
    default:
      return std::nullopt;
  }
}

Told of_switches(const gcode::Switches& switches, ControlName name) {
  switch (name) {
    case ControlName::SpindleOn:
      return switches.direction() != 0;
    case ControlName::SpindleClockwise:
      return switches.direction() > 0;
    case ControlName::Mist:
      return switches.mist();
    case ControlName::Flood:
      return switches.flood();
    case ControlName::Rpm:
      return switches.rpm();
    case ControlName::CurrentTool:
      return switches.tool();
    case ControlName::SelectedTool:
      return switches.selected();
    default:
      return std::nullopt;
  }
}

Told by_name(const gcode::Interpreter& interpreter, const Flow& flow, ControlName name) {
  switch (name) {
    case ControlName::X:
      return interpreter.tip(0);
    case ControlName::Y:
      return interpreter.tip(1);
    case ControlName::Z:
      return interpreter.tip(2);
    case ControlName::UnitsPerTurn:
    case ControlName::SpindleCssMode:
    case ControlName::LatheDiameter:
    case ControlName::AdaptiveFeed:
      return 0;
    case ControlName::SpindleRpmMode:
    case ControlName::LatheRadius:
    case ControlName::SpeedOverride:
    case ControlName::FeedOverride:
    case ControlName::FeedHold:
    case ControlName::Task:  // this is what the machine moves by, and no preview
      return 1;
    case ControlName::CoordinateSystem:
      return system_code(interpreter.coordinates().active());
    case ControlName::CallLevel:
      return static_cast<double>(flow.call_level());
    case ControlName::Line:
      return static_cast<double>(flow.number());
    default:
      break;
  }
  const Told mode = of_modes(interpreter.modes(), name);
  return mode ? mode : of_switches(interpreter.switches(), name);
}

}  // namespace

Told told(const gcode::Interpreter& interpreter, const Flow& flow, const gcode::Name& name) {
  if (const int* number = std::get_if<int>(&name)) return by_number(interpreter, *number);
  const auto known = control_name(std::get<std::string_view>(name));
  return known ? by_name(interpreter, flow, *known) : std::nullopt;
}

}  // namespace rmac::rs274
