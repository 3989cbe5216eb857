#include "clients/legacy/gcode/interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/legacy/gcode/blocks/comments.hpp"
#include "clients/legacy/gcode/modes/feeds.hpp"
#include "clients/legacy/gcode/modes/offsets.hpp"
#include "clients/legacy/gcode/named_io.hpp"
#include "clients/legacy/gcode/polar.hpp"

namespace rmac::gcode {

namespace {

constexpr double kInch_mm = 25.4, kMostTolerance_mm = 100, kMostDwell_s = 3600;
constexpr int kSpindleOff = 5, kFirstOfState = 70, kRadiusOff = 400;
/// How often M98 calls.
constexpr double kMostTimes = 1e9;
/// What a stop's message may have.
constexpr std::size_t kMostMessage_bytes = 200;

/// G10, G52 and G92 to G92.3.
bool sets_coordinates(int once) {
  return once == 100 || once == 520 || (once >= 920 && once <= 923);
}

double unit_of(const Code& units) {
  return units.number == 200 || units.number == kInchOfMach ? kInch_mm : 1;
}

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, std::min(text.find_last_not_of(" \t\r") - begin + 1, kMostMessage_bytes)));
}

/// M50 to M53: what is in force anyway is no more than said.
void keep_overrides(Block& block) {
  constexpr int kFirstOverride = 50, kAdaptiveFeed = 52, kLastOverride = 53;
  const auto& code = block.m(MGroup::Override);
  if (!code || code->number < kFirstOverride || code->number > kLastOverride) return;
  const Word* word = block.find('P');
  const bool on = word == nullptr || word->value != 0;
  if (on == (code->number == kAdaptiveFeed)) refuse(code->place, fmt::format("M{}: {}", code->number, kOverridesStay));
}

After save_or_restore(const Block& block, const Code& code) {
  if (block.codes() > 1) refuse(code.place, fmt::format("M{} has a block of its own; write two", code.number));
  block.require_all_used();
  return {After::What::Modes, code.number, 1, code.place};
}

}  // namespace

void require_nothing_behind(const Block& block, std::string_view what) {
  for (const MGroup group : {MGroup::Stop, MGroup::CoolantOff, MGroup::Spindle}) {
    const auto& code = block.m(group);
    if (!code || (group == MGroup::Spindle && code->number != kSpindleOff)) continue;
    refuse(code->place, fmt::format("M{} beside {}; write it in a block of its own", code->number, what));
  }
}

Interpreter::Interpreter(const Options& options, const Rules& rules, Writer& writer)
    : options_(options),
      rules_(rules),
      writer_(writer),
      mover_(options, rules, modes_, coordinates_, writer),
      compensation_([this](const ContourMove& move, std::size_t place) { mover_.held(move, place); },
                    rules.radius_is_offset),
      motions_(options, rules, modes_, coordinates_, mover_, compensation_),
      doubts_(modes_, coordinates_),
      turning_(modes_, coordinates_, doubts_, mover_),
      tool_axis_(options, rules, modes_, coordinates_, turning_, mover_),
      splines_(motions_, modes_, mover_),
      switches_(writer),
      drilling_(rules, modes_, coordinates_, mover_, switches_, writer) {
  modes_.unit_mm = options.unit_mm;
  modes_.whole_numbers = options.whole_numbers;
  for (const auto& [system, offset] : options.offsets) coordinates_.set_offset(system, offset);
}

After Interpreter::execute(Block& block, const Line& line) {
  read_comments(line);
  if (block.empty()) return {};
  if (splines_.open()) {
    splines_.go_on(block);
    block.require_all_used();
    return {};
  }
  if (const auto& code = block.m(MGroup::Stop); code && code->number >= 98) return numbered_program(block, *code);
  if (const auto& code = block.m(MGroup::Override); code && code->number >= kFirstOfState)
    return save_or_restore(block, *code);
  require_only_moves(block, modes_, compensation_);
  keep_overrides(block);
  set_speeds(block);
  set_tool(block);
  if (!(switches_off_behind(block) && block.m(MGroup::CoolantOff))) switches_.switch_coolant(block);
  switches_.write();
  act_on_names(block, options_, writer_);
  dwell(block);
  set_plane_and_units(block);
  if (const auto& code = block.g(GGroup::Radius); code && code->number != kRadiusOff) doubts_.require_none(code->place);
  switch_compensation(block, options_, rules_, modes_, switches_, mover_, compensation_);
  set_length(block);
  if (const auto& system = block.g(GGroup::System)) {
    select_system(block, *system, rules_, coordinates_);
    tool_axis_.follow(system->place);
  }
  set_control(block);
  set_distances(block);
  if (block.is_polar() && !(block.polar_radius() && block.polar_angle() && !modes_.incremental))
    doubts_.require_none(block.polar_radius() ? block.polar_radius()->place : block.polar_angle()->place);
  place_polar(block, modes_, {tip(0), tip(1)});
  turning_.act(block);
  if (const auto& turn = block.g(GGroup::Turn)) tool_axis_.settle(turn->place);
  act_once(block);
  for (const char letter : {'A', 'B', 'C'}) {
    if (block.has(letter) && !options_.rotary.empty()) require_no_contour(block.place(letter));
  }
  tool_axis_.read(block);
  move(block);
  switch_off_behind_motion(block);
  const bool goes_on = stop(block);
  block.require_all_used();
  return {goes_on ? After::What::Next : After::What::End};
}

void Interpreter::read_comments(const Line& line) {
  block_comment_.clear();
  for (const std::string_view comment : line.comments()) {
    const auto message = message_of(comment);
    (message ? message_ : block_comment_) = trimmed(message.value_or(comment));
  }
}

void Interpreter::set_speeds(Block& block) {
  const auto& units = block.g(GGroup::Units);
  set_feed(block, units ? std::optional(unit_of(*units)) : std::nullopt, rules_, modes_);
  if (const Word* speed = block.find('S')) switches_.set_speed(*speed);
}

void Interpreter::set_tool(Block& block) {
  if (const Word* tool = block.find('T')) switches_.select_tool(*tool);
  if (const auto& change = block.m(MGroup::Tool)) {
    switches_.change_tool(change->place);
    coordinates_.forget_tip();
    doubts_.settle();
    modes_.length = ToolLength::Off;
  }
  const auto& spindle = block.m(MGroup::Spindle);
  if (spindle && rules_.spindle_needs_speed && spindle->number != kSpindleOff && !switches_.speed_is_set())
    refuse(spindle->place, "no S was given before this; write S, in turns a minute, beside it");
  if (spindle && !(switches_off_behind(block) && spindle->number == kSpindleOff))
    switches_.turn_spindle(spindle->number);
}

/// A change of tool would switch on what is to be off, before that.
bool Interpreter::switches_off_behind(const Block& block) const {
  return rules_.stops_behind_motion && !block.m(MGroup::Tool);
}

void Interpreter::switch_off_behind_motion(const Block& block) {
  if (!switches_off_behind(block)) return;
  const auto& spindle = block.m(MGroup::Spindle);
  if (spindle && spindle->number == kSpindleOff) switches_.turn_spindle(spindle->number);
  if (block.m(MGroup::CoolantOff)) switches_.switch_coolant(block);
  switches_.write();
}

void Interpreter::dwell(Block& block) {
  if (!block.once(40)) return;
  const std::size_t place = block.g(GGroup::Once)->place;
  if (!block.has('P')) refuse(place, "G4 needs P, its time in seconds");
  const Word& time = block.use('P');
  const double seconds = time.value * (time.whole ? rules_.whole_dwell_s : 1);
  if (seconds < 0 || seconds > kMostDwell_s) refuse(time.place, "a dwell is 0 to 3600 seconds");
  writer_.dwell(seconds);
}

void Interpreter::set_plane_and_units(Block& block) {
  if (const auto& plane = block.g(GGroup::Plane)) {
    modes_.plane = plane->number == 170 ? Plane{} : plane->number == 180 ? Plane{2, 0, 1} : Plane{1, 2, 0};
  }
  const auto& units = block.g(GGroup::Units);
  if (!units) return;
  const double unit = unit_of(*units);
  if (units->number >= kInchOfMach && modes_.unit_mm != unit)
    refuse(units->place,
           fmt::format("{} is a unit on some controls and a cycle of lathes on others; write {} before it",
                       g_name(units->number), unit == 1 ? "G21" : "G20"));
  const bool ends_feed = rules_.unit_ends_feed && !block.has('F');
  if (ends_feed && modes_.unit_mm && *modes_.unit_mm != unit) modes_.feed_mm_min = 0;
  modes_.unit_mm = unit;
  modes_.unit_is_said = true;
}

void Interpreter::set_length(Block& block) {
  const auto& length = block.g(GGroup::Length);
  if (!length) return;
  if (length->number == 490) {
    modes_.length = ToolLength::Off;
    modes_.centre_point = ToolCentrePoint::Off;
    return tool_axis_.settle(length->place);
  }
  modes_.centre_point = length->number == 434   ? ToolCentrePoint::Angles
                        : length->number == 435 ? ToolCentrePoint::Vectors
                                                : ToolCentrePoint::Off;
  tool_axis_.settle(length->place);
  if (const Word* entry = block.find('H'); entry != nullptr && switches_.tool() != entry->value) {
    refuse(
        entry->place,
        switches_.tool()
            ? fmt::format("the length of another tool than the one in the spindle, {}, is not taken; write H{} or no H",
                          *switches_.tool(), *switches_.tool())
            : fmt::format(
                  "the program does not say that tool {0} is in the spindle; write T{0} M6 before it, or G43 without H",
                  entry->value));
  }
  modes_.length = ToolLength::On;
}

void Interpreter::set_control(Block& block) {
  const auto& control = block.g(GGroup::Control);
  if (!control) return;
  if (control->number == 610) {
    return set_path_tolerance(0);
  }
  std::optional<double> tolerance = options_.tolerance_mm;
  if (const Word* wanted = block.find('P'); wanted != nullptr && wanted->value != 0) tolerance = modes_.mm(*wanted);
  static_cast<void>(block.find('Q'));  // lines that the control may take together: it does so within P anyway
  const bool is_exact = tolerance_mm_ == 0;
  if (!tolerance && !rules_.needs_path_tolerance && !is_exact) return;
  if (!tolerance)
    refuse(control->place,
           "G64 without P leaves open how far the path may be from what is programmed; write P, or give --tolerance");
  if (!(*tolerance >= 0 && *tolerance <= kMostTolerance_mm)) refuse(control->place, "a path tolerance is 0 to 100 mm");
  set_path_tolerance(*tolerance);
}

void Interpreter::set_path_tolerance(double mm) {
  tolerance_mm_ = mm;
  writer_.path_tolerance(mm);
}

void Interpreter::set_distances(Block& block) {
  if (const auto& distance = block.g(GGroup::Distance)) modes_.incremental = distance->number == 910;
  if (const auto& centres = block.g(GGroup::ArcDistance)) modes_.absolute_centres = centres->number == 901;
  if (const auto& back = block.g(GGroup::Return)) modes_.retract_to_r = back->number == 990;
}

void Interpreter::act_once(Block& block) {
  const auto& once = block.g(GGroup::Once);
  if (!once) return;
  if (once->number == 280 || once->number == 300) {
    if (block.has_any("ABC") && !block.has_any("XYZ")) return;  // these alone are what the tool's axis is asked for
    tool_axis_.require_axes_of_machine(block, once->place);
    doubts_.reach_reference(block);
    return motions_.reference(block, *once);
  }
  if (once->number == 531 || once->number == 536) return turning_.align(block, once->place);
  if (!sets_coordinates(once->number)) return;
  require_unplaced(coordinates_, once->place);
  if (once->number == 920) doubts_.require_none_of(block);
  rules_.set_coordinates(block, *once, modes_, coordinates_);
  tool_axis_.follow(once->place);
}

void Interpreter::move(Block& block) {
  const auto& motion = block.g(GGroup::Motion);
  if (motion) {
    const bool only_mode = (motion->number == 0 || motion->number == 10) && !block.has_any("XYZ") && !mover_.turns();
    const bool ends_cycle = motion->number == Modes::kNoMotion;
    if (!ends_cycle && !only_mode) return move_by(block, motion->number, motion->place);
    if (only_mode) modes_.interpolation = motion->number;
    modes_.motion = ends_cycle && rules_.motion_outlives_cycles ? modes_.interpolation : motion->number;
    if (!(ends_cycle && rules_.motion_outlives_cycles)) return;
  }
  if (block.axes_are_taken() || !(block.has_any("XYZ") || mover_.turns())) return;
  const char letter = block.has('X') ? 'X' : block.has('Y') ? 'Y' : 'Z';
  const std::size_t place = block.has(letter) ? block.use(letter).place : 0;
  if (modes_.motion == Modes::kNoMotion) refuse(place, "no G0, G1 or other motion is in force that could use this");
  move_by(block, modes_.motion, place);
}

void Interpreter::move_by(Block& block, int code, std::size_t place) {
  const int before = std::exchange(modes_.motion, code);
  if (code <= 30) modes_.interpolation = code;
  tool_axis_.require_coordinates(block, place);
  doubts_.require_whole(block, code, rules_.cycles, place);
  if (code == 0 || code == 10) return motions_.straight(block, code == 0, place);
  if (code == 20 || code == 30) return motions_.arc(block, code == 30, place);
  if (code >= 50 && code <= 53) {
    if (modes_.inverse_time) refuse(place, "a spline under G93 is not taken; write G94 and F before it");
    return splines_.move(block, code, before, place);
  }
  if (compensation_.on() || compensation_.leaving())
    refuse(place,
           "a cycle goes by where the tool is; end cutter radius compensation by G40 and a straight move before it");
  if (modes_.inverse_time)
    refuse(place, "a canned cycle has a way of many moves, and G93 a time of one; write G94 before it");
  if (rules_.stops_behind_motion) require_nothing_behind(block, "a hole acts above it, before it is drilled");
  drilling_.drill(block, code, before, place);
}

bool Interpreter::stop(const Block& block) {
  const auto& stop = block.m(MGroup::Stop);
  if (!stop) return true;
  if (stop->number == 2 || stop->number == 30) {
    compensation_.end(stop->place);
    switches_.off();
    return false;
  }
  std::string message = block_comment_.empty() ? message_ : block_comment_;
  if (stop->number == 60 && message.empty()) message = "exchange the pallets (M60)";
  this->stop(stop->number == 1, message);
  message_.clear();
  return true;
}

void Interpreter::stop(bool optional, std::string_view message) {
  if (rules_.stops_switch_off) {
    // Whether an optional one stops anything is only known at the machine: no tool is to go on there without turning.
    if (optional) {
      switches_.stop_coolant();
    } else {
      switches_.off();
    }
  }
  writer_.stop(optional, message);
}

/// M98 and M99. What stands beside them LinuxCNC passes over, and other controls carry out first.
After Interpreter::numbered_program(Block& block, const Code& code) {
  if (block.codes() > 1) refuse(code.place, fmt::format("M{} has a block of its own; write two", code.number));
  if (code.number == 99) {
    block.require_all_used();
    return {After::What::EndOfNumbered, 0, 1, code.place};
  }
  if (!block.has('P')) refuse(code.place, "M98 needs P, the number of the program that it calls");
  const Word& label = block.use('P');
  if (!(label.value >= 0 && label.value <= kMostTimes && label.value == std::floor(label.value)))
    refuse(label.place, "P of M98 is the number behind the O of a program");
  const Word* times = block.find('L');
  if (times != nullptr &&
      !(times->value >= 0 && times->value <= kMostTimes && times->value == std::floor(times->value)))
    refuse(times->place, "L of M98 says how often: 0 or a greater integer");
  block.require_all_used();
  return {After::What::Call, static_cast<int>(label.value), times != nullptr ? static_cast<int>(times->value) : 1,
          code.place};
}

State Interpreter::state(std::size_t place) const {
  require_no_contour(place);
  return {modes_, coordinates_.active(), tolerance_mm_, switches_.state()};
}

void Interpreter::restore(const State& saved, std::size_t place) {
  require_no_contour(place);
  if (saved.system != coordinates_.active()) {
    activate_system(saved.system, place, rules_, coordinates_);
    tool_axis_.follow(place);
  }
  if (saved.tolerance_mm != tolerance_mm_ && !saved.tolerance_mm)
    refuse(place,
           "how far the path may be from what is programmed was not said when it was saved; write G61 or G64 P before "
           "M70 or M73");
  if (saved.tolerance_mm != tolerance_mm_) set_path_tolerance(*saved.tolerance_mm);
  const Modes now = std::exchange(modes_, saved.modes);
  modes_.motion = now.motion;
  modes_.interpolation = now.interpolation;
  // What the machine had before the program said anything may as well have been G49.
  if (saved.modes.length == ToolLength::Unsaid && now.length != ToolLength::Unsaid) modes_.length = ToolLength::Off;
  switches_.restore(saved.switches);
}

void Interpreter::require_no_contour(std::size_t place) const {
  if (compensation_.on() || compensation_.leaving())
    refuse(place, "cutter radius compensation is on, and takes moves and feeds alone; write G40 before this");
}

std::optional<double> Interpreter::tip(std::size_t axis) const {
  if (!modes_.unit_mm || compensation_.on() || compensation_.leaving()) return std::nullopt;
  if (coordinates_.placement() || doubts_.left_open(axis)) return std::nullopt;
  const auto tip = coordinates_.program_tip(axis);
  return tip ? std::optional(*tip / *modes_.unit_mm) : std::nullopt;
}

}  // namespace rmac::gcode
