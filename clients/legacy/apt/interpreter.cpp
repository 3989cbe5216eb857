#include "clients/legacy/apt/interpreter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace rmac::apt {

namespace {

constexpr double kMostDwell_s = 3600;
constexpr std::size_t kMostMessage_bytes = 200;

/// Statements that describe, print, or hold for a tape: they change neither a motion nor a switch.
constexpr std::array<std::string_view, 23> kPassed{"AUTOPS", "CUTTER", "INTOL",  "OUTTOL", "TOLER",   "REWIND",
                                                   "LEADER", "SEQNO",  "ISN",    "CLPRNT", "NOPOST",  "PRINT",
                                                   "$$",     "PARTNO", "REMARK", "TITLES", "DISPLY",  "TPRINT",
                                                   "MACHIN", "TLDATA", "PAINT",  "PPRINT", "TOOLPATH"};

/// A statement that is passed with this word alone: it says what is so anyway.
void require_word(Arguments& arguments, std::initializer_list<std::string_view> words, std::string_view why) {
  const std::string& word = arguments.word("its word");
  if (std::find(words.begin(), words.end(), word) == words.end())
    refuse(arguments.last_place(), fmt::format("{}/{}: {}", arguments.major(), word, why));
}

void require_no_shift(Arguments& arguments) {
  for (const double value : arguments.numbers({3, 9}, "x,y,z")) {
    if (value == 0) continue;
    refuse(
        arguments.place(),
        "ORIGIN that is not 0,0,0: CAM systems do not agree on what it shifts; have the CAM system write coordinates "
        "of the part, or use TRANS");
  }
}

}  // namespace

Interpreter::Interpreter(const Options& options, Writer& writer)
    : writer_(writer),
      coordinates_(options),
      mover_(options, writer),
      motions_(options, coordinates_, mover_, writer),
      switches_(writer),
      tools_(writer) {}

const std::map<std::string_view, Interpreter::Verb>& Interpreter::verbs() {
  using I = Interpreter;
  using A = Arguments;
  static const std::map<std::string_view, Verb> kVerbs{
      {"GOTO", {[](I& i, A& a) { i.motions_.go_to(a); }, true}},
      {"GODLTA", {[](I& i, A& a) { i.motions_.go_by(a); }, true}},
      {"TLON,GOFWD", {[](I& i, A& a) { i.motions_.follow(a); }, true}},
      {"GOHOME", {[](I& i, A& a) { i.motions_.go_home(a); }, true}},
      {"FROM", {[](I& i, A& a) { i.motions_.from(a); }, false}},
      {"RAPID", {[](I& i, A& a) { i.motions_.set_rapid(a); }, false}},
      {"FEDRAT", {[](I& i, A& a) { i.motions_.set_feed(a); }, false}},
      {"INDIRV", {[](I& i, A& a) { i.motions_.arcs().set_forward(a); }, false}},
      {"PSIS", {[](I& i, A& a) { i.motions_.arcs().set_surface(a); }, false}},
      {"CIRCLE", {[](I& i, A& a) { i.motions_.arcs().set_circle(a); }, false}},
      {"MOVARC", {[](I& i, A& a) { i.motions_.arcs().set_arc(a); }, false}},
      {"CYCLE", {[](I& i, A& a) { i.motions_.drilling().set(a); }, false}},
      {"UNITS", {[](I& i, A& a) { i.coordinates_.set_unit(a); }, false}},
      {"MULTAX", {[](I& i, A& a) { i.coordinates_.set_multax(a); }, false}},
      {"TLAXIS", {[](I& i, A& a) { i.coordinates_.set_axis(a); }, false}},
      {"TRANS", {[](I& i, A& a) { i.coordinates_.set_translation(a); }, false}},
      {"SPINDL", {[](I& i, A& a) { i.switches_.set_spindle(a); }, false}},
      {"COOLNT", {[](I& i, A& a) { i.switches_.set_coolant(a); }, false}},
      {"LOADTL", {[](I& i, A& a) { i.load(a); }, false}},
      {"LOAD", {[](I& i, A& a) { i.load(a); }, false}},
      {"SELECT", {[](I&, A& a) { Tools::select(a); }, false}},
      {"SELCTL", {[](I&, A& a) { Tools::select(a); }, false}},
      {"TOOLNO", {[](I& i, A& a) { i.tools_.describe(a); }, false}},
      {"MSYS", {[](I& i, A& a) { i.systems_.set(a); }, false}},
      {"DELAY", {[](I& i, A& a) { i.dwell(a); }, false}},
      {"DWELL", {[](I& i, A& a) { i.dwell(a); }, false}},
      {"STOP", {[](I& i, A& a) { i.stop(a, false); }, false}},
      {"OPSTOP", {[](I& i, A& a) { i.stop(a, true); }, false}},
      {"END", {[](I& i, A& a) { i.end_program(a); }, false}},
      {"FINI", {[](I& i, A& a) { i.end_program(a); }, false}},
      {"END-OF-PATH", {[](I& i, A& a) { i.end_path(a); }, false}},
      {"ORIGIN", {[](I&, A& a) { require_no_shift(a); }, false}},
      {"MODE", {[](I&, A& a) { require_word(a, {"MILL"}, "only MILL is taken"); }, false}},
      {"ARCSLP",
       {[](I&, A& a) {
          require_word(a, {"ON", "OFF"}, "only ON and OFF are taken");
        },
        false}},
      {"OPSKIP", {[](I&, A& a) { require_word(a, {"OFF"}, "blocks that may be left out are not taken"); }, false}},
      {"CUTCOM",
       {[](I&, A& a) {
          require_word(a, {"OFF"}, "compensation is not taken; have the CAM system give the path of the tool's centre");
        },
        false}},
  };
  return kVerbs;
}

bool Interpreter::take_text(const Statement& statement) {
  if (std::ranges::find(kPassed, statement.major) == kPassed.end()) return false;
  if (statement.major == "$$") {
    systems_.read_comment(statement);
    return true;
  }
  systems_.end_comments();
  if (statement.major == "PPRINT") message_ = statement.text.substr(0, kMostMessage_bytes);
  if (statement.major == "TOOLPATH") {
    tools_.begin_path(statement);
    path_ended_ = false;
  }
  return true;
}

bool Interpreter::execute(const Statement& statement) {
  const std::string& major = statement.major;
  const auto found = verbs().find(major);
  if (found == verbs().end()) {
    if (take_text(statement)) return true;
    refuse(statement.place,
           fmt::format("{} is not understood, so what it would change is not known; take it out if it changes nothing",
                       major));
  }
  if (ended_ && major != "FINI") refuse(statement.place, fmt::format("{} behind END", major));
  systems_.end_comments();
  path_ended_ = false;
  if (found->second.moves) tools_.require_meant(statement.place);
  Arguments arguments(statement);
  found->second.deed(*this, arguments);
  arguments.end();
  message_.clear();
  return major != "FINI";
}

void Interpreter::dwell(Arguments& arguments) {
  if (arguments.take("REV")) refuse(arguments.last_place(), "a dwell is in seconds here, not in turns of the spindle");
  const double seconds = arguments.number("seconds");
  if (!(seconds >= 0 && seconds <= kMostDwell_s)) refuse(arguments.last_place(), "a dwell is 0 to 3600 seconds");
  arguments.end();
  writer_.dwell(seconds);
}

void Interpreter::stop(Arguments& arguments, bool optional) {
  arguments.end();
  writer_.stop(optional, message_);
}

void Interpreter::load(Arguments& arguments) {
  motions_.arcs().require_complete(arguments.place());
  tools_.load(arguments);
  switches_.tool_was_changed();
  mover_.forget();
}

void Interpreter::end_program(Arguments& arguments) {
  arguments.end();
  motions_.arcs().require_complete(arguments.place());
  ended_ = true;
  switches_.off();
}

void Interpreter::end_path(Arguments& arguments) {
  arguments.end();
  path_ended_ = true;
}

void Interpreter::end(std::size_t place) {
  if (!ended_ && !path_ended_) refuse(place, "the program ends without FINI, END or END-OF-PATH; it may be cut off");
  motions_.arcs().require_complete(place);
  switches_.off();
}

}  // namespace rmac::apt
