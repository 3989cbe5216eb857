#include "clients/legacy/fanuc/blocks/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/blocks/rewriting.hpp"

namespace rmac::fanuc {

namespace {

constexpr int kMostProgram = 99'999'999, kMostTimes = 9999;

constexpr double kMostCode = 1e6;

/// A code's number by tens; none where it is no such.
std::optional<int> tenfold_of(double value) {
  constexpr double kNear = 1e-6;
  const double nearest = std::round(value * 10);
  if (!(std::abs(value * 10 - nearest) < kNear) || nearest < 0 || nearest > kMostCode) return std::nullopt;
  return static_cast<int>(nearest);
}

/// A value that was computed, to the least input increment of its word.
double incremented(const FanucWord& word, const gcode::Modes& modes) {
  constexpr std::string_view kLengths = "XYZUVWIJKRQ", kAngles = "ABC";
  const bool is_direction =
      word.letter >= 'I' && word.letter <= 'K' && modes.centre_point == gcode::ToolCentrePoint::Vectors;
  const bool is_length = kLengths.find(word.letter) != std::string_view::npos && !is_direction;
  const bool is_angle = kAngles.find(word.letter) != std::string_view::npos;
  if (!is_length && !is_angle) return word.word.value;
  const bool inch = is_length && modes.unit_mm && *modes.unit_mm != 1;
  const double per_unit = inch ? 1e4 : 1e3;
  return std::round(word.word.value * per_unit) / per_unit;
}

void take_call(gcode::Block& block, Ordered& ordered) {
  if (!block.has('P')) refuse(ordered.place, "M98 needs P, the number of the program that it calls");
  ordered.program = integer_of(block.take('P'), 1, kMostProgram, "P of M98 is the number of a program");
  if (!block.has('L')) return;
  ordered.times = integer_of(block.take('L'), 1, kMostTimes, "L of M98 says how often");
  ordered.times_are_said = true;
}

void take_local_call(gcode::Block& block, Ordered& ordered) {
  if (!block.has('P')) refuse(ordered.place, "M97 needs P, the N of the line that it calls");
  ordered.label = integer_of(block.take('P'), 1, kMostProgram, "P of M97 is the N of a line");
  if (block.has('L')) ordered.times = integer_of(block.take('L'), 1, kMostTimes, "L of M97 says how often");
}

void take_return(gcode::Block& block, Ordered& ordered) {
  if (block.has('P')) ordered.label = integer_of(block.take('P'), 1, kMostProgram, "P of M99 is the N of a line");
}

}  // namespace

Ordered BlockReader::read(std::string_view text, std::size_t at, const Variables& variables, const gcode::Modes& modes,
                          gcode::Block& block) {
  block.clear();
  look_ahead_.reset();
  haas_.cycle.reset();
  haas_.switched.clear();
  Ordered ordered;
  for (skip_comments(text, at); at < text.size(); skip_comments(text, at)) {
    if (text[at] == '#') refuse(at, "a variable is set in a line of its own");
    FanucWord word = read_word(text, at, variables, modes);
    if (word.computed) word.word.value = incremented(word, modes);
    if (!word.vacant) add(word, block, ordered);
  }
  block.check_together();
  rewrite_dwell(block, modes);
  rewrite_reference(block, is_haas_);
  if (polar_) rewrite_polar(block, modes);
  if (look_ahead_) pass_over_look_ahead(block, *look_ahead_);
  if (ordered.what == Ordered::What::Call) take_call(block, ordered);
  if (ordered.what == Ordered::What::CallLocal) take_local_call(block, ordered);
  if (ordered.what == Ordered::What::Return) take_return(block, ordered);
  return ordered;
}

void BlockReader::add(const FanucWord& word, gcode::Block& block, Ordered& ordered) {
  if (word.letter == 'G') return add_g(word.word, block, ordered);
  if (word.letter == 'M') return add_m(word.word, block, ordered);
  block.add_word(word.letter, word.word);
}

void BlockReader::add_g(const gcode::Word& word, gcode::Block& block, Ordered& ordered) {
  const auto tenfold = tenfold_of(word.value);
  const FanucG* of_haas = tenfold ? find_haas_g(*tenfold) : nullptr;
  const FanucG* known = is_haas_ && of_haas != nullptr ? of_haas : tenfold ? find_g(*tenfold) : nullptr;
  if (known == nullptr)
    refuse(word.place, fmt::format("there is no G{:g} here{}", word.value,
                                   of_haas != nullptr ? "; of a Haas' program --dialect haas knows it" : ""));
  const gcode::Code code{*tenfold, word.place};
  switch (known->use) {
    case Use::Block:
      return block.add_g(known->code, word.place);
    case Use::Nothing:
      return;
    case Use::LookAhead:
      return set_only(look_ahead_, code);
    case Use::HaasCycle:
      return set_only(haas_.cycle, code);
    case Use::PolarOn:
    case Use::PolarOff:
      polar_ = known->use == Use::PolarOn;
      return;
    case Use::EndOfModalCall:
      ordered.ends_modal_call = true;
      return;
  }
}

void BlockReader::add_m(const gcode::Word& word, gcode::Block& block, Ordered& ordered) {
  constexpr int kMostM = 99'999'999, kLocalCall = 97, kCall = 98, kReturn = 99;
  const int number = integer_of(word, 0, kMostM, "M is a whole number");
  const bool is_local = is_haas_ && number == kLocalCall;
  if (is_local || number == kCall || number == kReturn) {
    if (ordered.what != Ordered::What::Next) refuse(word.place, "one of M97, M98 and M99 in a block; write two blocks");
    ordered.what = is_local            ? Ordered::What::CallLocal
                   : number == kReturn ? Ordered::What::Return
                                       : Ordered::What::Call;
    ordered.place = word.place;
    return;
  }
  if (is_haas_ && add_haas_m(number, word.place, block)) return;
  const gcode::MCode* known = find_m(number);
  if ((known == nullptr || !known->refusal.empty()) && passed_m_.contains(number)) return;
  if (known == nullptr)
    refuse(word.place, fmt::format("M{0} is a code of the machine's builder, and what it does is not known here; write "
                                   "that out, or give --pass-over M{0} where nothing is to be done{1}",
                                   number,
                                   !is_haas_ && (number == kLocalCall || find_haas_m(number) != nullptr)
                                       ? "; of a Haas' program --dialect haas knows it"
                                       : ""));
  block.add_m(*known, word.place);
}

void BlockReader::add_switched(const HaasWords::Switched& switched) {
  if (std::ranges::find(haas_.switched, switched.number, &HaasWords::Switched::number) != haas_.switched.end())
    refuse(switched.place,
           fmt::format("what M{} switches is switched twice in one block; write two blocks", switched.number));
  haas_.switched.push_back(switched);
}

bool BlockReader::add_haas_m(int number, std::size_t place, gcode::Block& block) {
  const HaasM* own = find_haas_m(number);
  if (own == nullptr) return false;
  if (own->use != HaasM::Use::As && passed_m_.contains(number)) return true;
  switch (own->use) {
    case HaasM::Use::Nothing:
      break;
    case HaasM::Use::SwitchOn:
      add_switched({number, true, own->message, place});
      break;
    case HaasM::Use::SwitchOff:
      add_switched({own->as, false, {}, place});
      break;
    case HaasM::Use::As:
      block.add_m(*find_m(own->as), place);
      break;
    case HaasM::Use::Refused:
      refuse(place, fmt::format("M{0}: {1}; where the program may go without it, give --pass-over M{0}", number,
                                own->message));
  }
  return true;
}

void BlockReader::set_only(std::optional<gcode::Code>& there, const gcode::Code& code) {
  if (there)
    refuse(code.place, fmt::format("{} and {} in one block; write two blocks", gcode::g_name(there->number),
                                   gcode::g_name(code.number)));
  there = code;
}

}  // namespace rmac::fanuc
