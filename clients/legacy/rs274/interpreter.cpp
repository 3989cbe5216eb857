#include "clients/legacy/rs274/interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/legacy/rs274/blocks/comments.hpp"
#include "clients/legacy/rs274/named_io.hpp"
#include "clients/legacy/rs274/offsets.hpp"

namespace rmac::rs274 {

namespace {

constexpr double kInch_mm = 25.4, kMostTolerance_mm = 100, kMostDwell_s = 3600;
/// How often M98 calls.
constexpr double kMostTimes = 1e9;
/// What a stop's message may have.
constexpr std::size_t kMostMessage_bytes = 200;

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return {};
  return std::string(text.substr(begin, std::min(text.find_last_not_of(" \t\r") - begin + 1, kMostMessage_bytes)));
}

}  // namespace

Interpreter::Interpreter(const Options& options, Writer& writer, Parameters& parameters)
    : options_(options),
      writer_(writer),
      parameters_(parameters),
      mover_(options, modes_, coordinates_, writer),
      compensation_([this](const ContourMove& move, std::size_t place) { mover_.held(move, place); }),
      motions_(options, modes_, coordinates_, mover_, compensation_),
      splines_(motions_, modes_, mover_),
      switches_(writer),
      drilling_(modes_, coordinates_, mover_, switches_, writer) {
  modes_.unit_mm = options.unit_mm;
  for (std::size_t system = 0; system < Coordinates::kSystems; ++system)
    coordinates_.set_offset(system, options.offsets.at(system));
  parameters_.ask_control([this](int number) { return control_parameter(number); });
}

After Interpreter::execute(const Line& line) {
  block_.read(line, parameters_);
  read_comments(line);
  if (block_.empty()) return {};
  if (splines_.open()) {
    splines_.go_on(block_);
    block_.require_all_used();
    return {};
  }
  if (const auto& code = block_.m(MGroup::Stop); code && code->number >= 98) return numbered_program(*code);
  require_only_moves(block_, modes_, compensation_);
  set_speeds();
  set_tool();
  switches_.switch_coolant(block_);
  switches_.write();
  act_on_names(block_, options_, writer_);
  dwell();
  set_plane_and_units();
  switch_compensation(block_, options_, modes_, switches_, mover_, compensation_);
  set_length();
  if (const auto& system = block_.g(GGroup::System)) select_system(*system, coordinates_);
  set_control();
  set_distances();
  act_once();
  move();
  const bool goes_on = stop();
  block_.require_all_used();
  return {goes_on ? After::What::Next : After::What::End};
}

void Interpreter::read_comments(const Line& line) {
  block_comment_.clear();
  if (line.comments().empty()) return;
  refuse_active_comments(line);
  for (const std::string_view comment : line.comments()) {
    const auto message = message_of(comment);
    (message ? message_ : block_comment_) = trimmed(message.value_or(comment));
  }
}

void Interpreter::set_speeds() {
  if (const Word* feed = block_.find('F')) {
    const auto& units = block_.g(GGroup::Units);
    const double unit = units && units->number == 200 ? kInch_mm : 1;
    if (units && modes_.unit_mm && *modes_.unit_mm != unit) {
      refuse(feed->place,
             "F in the block that changes the unit would count in the unit before it; write F in a block behind it");
    }
    if (feed->value < 0) refuse(feed->place, "a negative feed");
    modes_.feed_mm_min = units ? feed->value * unit : modes_.mm(*feed);
  }
  if (const Word* speed = block_.find('S')) switches_.set_speed(*speed);
}

void Interpreter::set_tool() {
  if (const Word* tool = block_.find('T')) switches_.select_tool(*tool);
  if (const auto& change = block_.m(MGroup::Tool)) {
    switches_.change_tool(change->place);
    coordinates_.forget_tip();
    modes_.length = ToolLength::Off;
  }
  if (const auto& spindle = block_.m(MGroup::Spindle)) switches_.turn_spindle(spindle->number);
}

void Interpreter::dwell() {
  if (!block_.once(40)) return;
  const std::size_t place = block_.g(GGroup::Once)->place;
  if (!block_.has('P')) refuse(place, "G4 needs P, its time in seconds");
  const Word& time = block_.use('P');
  if (time.value < 0 || time.value > kMostDwell_s) refuse(time.place, "a dwell is 0 to 3600 seconds");
  writer_.dwell(time.value);
}

void Interpreter::set_plane_and_units() {
  if (const auto& plane = block_.g(GGroup::Plane)) {
    modes_.plane = plane->number == 170 ? Plane{} : plane->number == 180 ? Plane{2, 0, 1} : Plane{1, 2, 0};
  }
  if (const auto& units = block_.g(GGroup::Units)) modes_.unit_mm = units->number == 200 ? kInch_mm : 1;
}

void Interpreter::set_length() {
  const auto& length = block_.g(GGroup::Length);
  if (!length) return;
  if (length->number == 490) {
    modes_.length = ToolLength::Off;
    return;
  }
  if (const Word* entry = block_.find('H'); entry != nullptr && switches_.tool() != entry->value) {
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

void Interpreter::set_control() {
  const auto& control = block_.g(GGroup::Control);
  if (!control) return;
  if (control->number == 610) return writer_.path_tolerance(0);
  std::optional<double> tolerance = options_.tolerance_mm;
  if (const Word* wanted = block_.find('P'); wanted != nullptr && wanted->value != 0) tolerance = modes_.mm(*wanted);
  static_cast<void>(block_.find('Q'));  // lines that the control may take together: it does so within P anyway
  if (!tolerance)
    refuse(control->place,
           "G64 without P leaves open how far the path may be from what is programmed; write P, or give --tolerance");
  if (!(*tolerance >= 0 && *tolerance <= kMostTolerance_mm)) refuse(control->place, "a path tolerance is 0 to 100 mm");
  writer_.path_tolerance(*tolerance);
}

void Interpreter::set_distances() {
  if (const auto& distance = block_.g(GGroup::Distance)) modes_.incremental = distance->number == 910;
  if (const auto& centres = block_.g(GGroup::ArcDistance)) modes_.absolute_centres = centres->number == 901;
  if (const auto& back = block_.g(GGroup::Return)) modes_.retract_to_r = back->number == 990;
}

void Interpreter::act_once() {
  const auto& once = block_.g(GGroup::Once);
  if (!once) return;
  if (once->number == 100) set_system(block_, modes_, coordinates_, once->place);
  if (once->number == 280 || once->number == 300) motions_.reference(block_, *once);
  if (once->number >= 920) shift_coordinates(block_, *once, modes_, coordinates_);
}

void Interpreter::move() {
  const auto& motion = block_.g(GGroup::Motion);
  const bool axes_are_taken = block_.once(100) || block_.once(920) || block_.once(280) || block_.once(300);
  if (motion) {
    const bool only_mode = (motion->number == 0 || motion->number == 10) && !block_.has_any("XYZ");
    if (motion->number == Modes::kNoMotion || only_mode) {
      modes_.motion = motion->number;
      return;
    }
    return move_by(motion->number, motion->place);
  }
  if (axes_are_taken || !block_.has_any("XYZ")) return;
  const char letter = block_.has('X') ? 'X' : block_.has('Y') ? 'Y' : 'Z';
  const std::size_t place = block_.use(letter).place;
  if (modes_.motion == Modes::kNoMotion) refuse(place, "no G0, G1 or other motion is in force that could use this");
  move_by(modes_.motion, place);
}

void Interpreter::move_by(int code, std::size_t place) {
  const int before = std::exchange(modes_.motion, code);
  if (code == 0 || code == 10) return motions_.straight(block_, code == 0, place);
  if (code == 20 || code == 30) return motions_.arc(block_, code == 30, place);
  if (code >= 50 && code <= 53) return splines_.move(block_, code, before, place);
  if (compensation_.on() || compensation_.leaving())
    refuse(place,
           "a cycle goes by where the tool is; end cutter radius compensation by G40 and a straight move before it");
  drilling_.drill(block_, code, before, place);
}

bool Interpreter::stop() {
  const auto& stop = block_.m(MGroup::Stop);
  if (!stop) return true;
  if (stop->number == 2 || stop->number == 30) {
    compensation_.end(stop->place);
    switches_.off();
    return false;
  }
  std::string message = block_comment_.empty() ? message_ : block_comment_;
  if (stop->number == 60 && message.empty()) message = "exchange the pallets (M60)";
  writer_.stop(stop->number == 1, message);
  message_.clear();
  return true;
}

/// M98 and M99. What stands beside them LinuxCNC passes over, and other controls carry out first.
After Interpreter::numbered_program(const Code& code) {
  if (block_.codes() > 1) refuse(code.place, fmt::format("M{} has a block of its own; write two", code.number));
  if (code.number == 99) {
    block_.require_all_used();
    return {After::What::EndOfNumbered, 0, 1, code.place};
  }
  if (!block_.has('P')) refuse(code.place, "M98 needs P, the number of the program that it calls");
  const Word& label = block_.use('P');
  if (!(label.value >= 0 && label.value <= kMostTimes && label.value == std::floor(label.value)))
    refuse(label.place, "P of M98 is the number behind the O of a program");
  const Word* times = block_.find('L');
  if (times != nullptr &&
      !(times->value >= 0 && times->value <= kMostTimes && times->value == std::floor(times->value)))
    refuse(times->place, "L of M98 says how often: 0 or a greater integer");
  block_.require_all_used();
  return {After::What::Call, static_cast<int>(label.value), times != nullptr ? static_cast<int>(times->value) : 1,
          code.place};
}

/// Of the numbers that LinuxCNC's manual gives to the control, those that a program's own words make known. Those of
/// G92 and the work systems (5211 to 5383) are not: the control keeps the former while G92.2 suspends them, and the
/// latter in the unit of the machine, which no program says.
std::optional<double> Interpreter::control_parameter(int number) const {
  if (number == 5220) return static_cast<double>(coordinates_.active() + 1);
  if (number == 5400) return switches_.tool();
  if (number < 5420 || number > 5422 || !modes_.unit_mm) return std::nullopt;
  if (compensation_.on() || compensation_.leaving()) return std::nullopt;  // beside where the program believes it to be
  const auto tip = coordinates_.program_tip(static_cast<std::size_t>(number - 5420));
  return tip ? std::optional(*tip / *modes_.unit_mm) : std::nullopt;
}

}  // namespace rmac::rs274
