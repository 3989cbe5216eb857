#include "clients/legacy/fanuc/flow/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/legacy/fanuc/blocks/grammar.hpp"
#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/flow/line_head.hpp"
#include "clients/legacy/gcode/blocks/codes.hpp"
#include "clients/legacy/gcode/values/expression.hpp"

namespace rmac::fanuc {

namespace {

/// What a control has within each other: macros, and macros and subprograms together.
constexpr std::size_t kDeepestMacros = 4, kDeepestCalls = 14;

void require_equals(std::string_view text, std::size_t at) {
  if (at >= text.size() || text[at] != '=') refuse(at, "= expected: a # at the begin of a line sets a variable");
}

/// POPEN, DPRNT and their like: what a control prints moves nothing.
constexpr std::size_t kPrinting = 5;

/// Where ends what is printed, whose brackets begin at `at`.
std::size_t behind_printed(std::string_view text, std::size_t at) {
  const std::size_t begin = at;
  int depth = 0;
  for (; at < text.size(); ++at) {
    if (text[at] == '[') ++depth;
    if (depth == 0) break;
    if (text[at] == ']' && --depth == 0) return at + 1;
  }
  refuse(begin, "what is printed stands in [ ]");
}

/// A statement that a condition leaves out: throws a Refusal where it is none.
void pass_over(std::string_view text, std::size_t at, bool sets) {
  struct Ones final : gcode::Variables {
    [[nodiscard]] gcode::Maybe value(const gcode::Name&, std::size_t) const override { return 1; }
    [[nodiscard]] bool is_set(const gcode::Name&) const override { return true; }
  };
  const Ones ones;
  gcode::Expression expression(text, grammar_of_syntax(), ones);
  if (sets) {
    static_cast<void>(expression.parameter_name(++at));
    require_equals(text, at);
    static_cast<void>(expression.without_brackets(++at));
  } else {
    static_cast<void>(expression.value(at));
  }
  require_line_end(text, at);
}

std::string name_of(int program) {
  return program != FanucProgram::kUnnumbered ? fmt::format("O{}", program) : "this program";
}

[[noreturn]] void refuse_label(int label, int program, std::size_t place) {
  refuse(place, fmt::format("there is no N{} in {}", label, name_of(program)));
}

}  // namespace

Flow::Flow(std::string_view text, bool block_delete, gcode::Bounds bounds, Variables& variables,
           const gcode::Modes& modes, std::function<gcode::Made()> made)
    : text_(text),
      block_delete_(block_delete),
      outline_(text),
      variables_(variables),
      modes_(modes),
      endless_(bounds, std::move(made)),
      frames_{Frame{}} {}

bool Flow::next() {
  if (const auto& trouble = outline_.trouble()) {
    next_ = trouble->line;
    read_line();
    refuse(trouble->place, trouble->message);
  }
  while (next_.at < text_.size()) {
    read_line();
    const std::string_view text = line_.text();
    const LineHead head = read_head(text);
    if (head.deletes && block_delete_) continue;
    if (head.number) last_label_ = *head.number;
    words_ = head.behind;
    skip_comments(text, words_);
    if (words_ >= text.size()) return true;
    begun_ = begun_ || std::string_view("%O:").find(text[words_]) == std::string_view::npos;
    if (!carry_out(text, words_)) return true;
  }
  return false;
}

void Flow::read_line() {
  const std::size_t end = std::min(text_.find('\n', next_.at), text_.size());
  here_ = next_;
  const std::string_view source = text_.substr(next_.at, end - next_.at);
  next_ = {std::min(end + 1, text_.size()), next_.lines + 1};
  furthest_ = std::max(furthest_, next_.lines);
  endless_.count();
  line_.read(source, gcode::LineComments::None);
}

/// False where the line is a block of words.
bool Flow::carry_out(std::string_view text, std::size_t at) {
  const auto begins = [&](std::string_view word) { return text.substr(at).starts_with(word); };
  if (begins("#")) {
    assign(text, at);
  } else if (begins("IF")) {
    carry_out_if(text, at);
  } else if (begins("WHILE") || begins("DO")) {
    begin_loop(text, at);
  } else if (begins("END")) {
    end_loop(at);
  } else if (begins("GOTO")) {
    carry_out_goto(text, at);
  } else if (begins("O") || begins(":")) {
    pass_number(at);
  } else if (begins("POPEN") || begins("PCLOS")) {
    require_line_end(text, at + kPrinting);
  } else if (begins("DPRNT") || begins("BPRNT")) {
    require_line_end(text, behind_printed(text, at + kPrinting));
  } else if (begins("SETVN")) {
    refuse(at, "names of variables are not taken; write their numbers");
  } else {
    return call_of_macro(text, at);
  }
  return true;
}

void Flow::pass_number(std::size_t place) {
  std::size_t at = place + 1;
  static_cast<void>(read_digits(line_.text(), at));
  const auto& programs = outline_.programs();
  const auto begins_here = [this](const FanucProgram& program) {
    return program.number != FanucProgram::kUnnumbered && program.begin == here_;
  };
  const auto found = std::ranges::find_if(programs, begins_here);
  const auto index = static_cast<std::size_t>(found - programs.begin());
  Frame& frame = frames_.back();
  const bool is_first = !begun_ && index == 1;
  if (is_first) frame.program = index;
  if (frame.program != index) {
    refuse(place, fmt::format("{} begins here while the program before it runs; end that with M30, or with M99 where "
                              "M98 or G65 calls it",
                              line_.text().substr(place, at - place)));
  }
  require_line_end(line_.text(), at);
}

void Flow::assign(std::string_view text, std::size_t at) {
  const std::size_t place = at++;
  gcode::Expression expression(text, grammar(), variables_);
  const int number = std::get<int>(expression.parameter_name(at));
  require_equals(text, at);
  ++at;
  const Maybe value = expression.without_brackets(at);
  require_line_end(text, at);
  variables_.set(number, value, line_.comments().empty() ? std::string_view() : line_.comments().front(), place);
}

bool Flow::holds(std::string_view text, std::size_t& at) const {
  const std::size_t place = at;
  if (at >= text.size() || text[at] != '[') refuse(at, "a condition stands in [ ]");
  const Maybe value = gcode::Expression(text, grammar(), variables_).maybe(at);
  if (value != 0 && value != 1) refuse(place, "a condition compares, as in [#1 EQ 2]; this is a value");
  return *value == 1;
}

void Flow::carry_out_if(std::string_view text, std::size_t at) {
  constexpr std::size_t kIf = 2, kThen = 4;
  at += kIf;
  const bool goes = holds(text, at);
  const std::string_view rest = text.substr(at);
  if (rest.starts_with("GOTO")) {
    return goes ? carry_out_goto(text, at) : pass_over(text, at + kThen, false);
  }
  if (!rest.starts_with("THEN")) refuse(at, "GOTO or THEN stands behind the condition of IF");
  at += kThen;
  if (at >= text.size() || text[at] != '#') refuse(at, "behind THEN a variable is set, as in THEN #1 = 2");
  if (goes) return assign(text, at);
  pass_over(text, at, true);
}

void Flow::begin_loop(std::string_view text, std::size_t at) {
  constexpr std::size_t kWhile = 5, kDoAndNumber = 3;
  const std::size_t index = outline_.loop_at(here_).value();
  const Loop& loop = outline_.loop(index);
  bool goes = true;
  if (text.substr(at).starts_with("WHILE")) {
    at += kWhile;
    goes = holds(text, at);
  }
  require_line_end(text, at + kDoAndNumber);
  if (goes) {
    frames_.back().loops.push_back(index);
  } else {
    next_ = loop.end;
  }
}

void Flow::end_loop(std::size_t place) {
  constexpr std::size_t kEndAndNumber = 4;
  require_line_end(line_.text(), place + kEndAndNumber);
  auto& loops = frames_.back().loops;
  if (loops.empty() || outline_.loop(loops.back()).end != next_)
    refuse(place, "the END of a loop that was not begun: something jumped into it");
  endless_.come_again(place);
  next_ = outline_.loop(loops.back()).begin;
  loops.pop_back();
}

void Flow::carry_out_goto(std::string_view text, std::size_t at) {
  constexpr std::size_t kGoto = 4;
  constexpr double kMostLabel = 999'999'999;
  const std::size_t place = at;
  at += kGoto;
  const double label = gcode::Expression(text, grammar(), variables_).value(at);
  require_line_end(text, at);
  if (!(label >= 1 && label <= kMostLabel) || label != std::round(label))
    refuse(place, fmt::format("GOTO goes to the N of a line, and not to {}", label));
  go_to(static_cast<int>(label), place);
}

void Flow::go_to(int label, std::size_t place) {
  Frame& frame = frames_.back();
  const auto spot = outline_.find_label(frame.program, label, next_);
  if (!spot) refuse_label(label, program(), place);
  auto around = outline_.loops_around(frame.program, *spot);
  const bool stays =
      around.size() <= frame.loops.size() && std::equal(around.begin(), around.end(), frame.loops.begin());
  if (!stays) refuse(place, fmt::format("N{} is within a loop that this is not in; nothing jumps into a loop", label));
  endless_.come_again(place);
  frame.loops = std::move(around);
  next_ = *spot;
}

/// G65 and G66, which stand at the begin of a block.
bool Flow::call_of_macro(std::string_view text, std::size_t at) {
  constexpr int kSimple = 65, kModal = 66;
  std::size_t behind = at + 1;
  if (text[at] != 'G') return false;
  const auto code = read_digits(text, behind);
  const bool ends = behind >= text.size() || text[behind] != '.';
  if (!ends || (code != kSimple && code != kModal)) return false;
  const MacroCall call = read_macro_call(text, behind, variables_, modes_);
  if (code == kSimple) {
    call_macro(call);
    return true;
  }
  if (modal_) refuse(at, "G66 within G66 is not taken; write G67 before it");
  modal_ = ModalCall{program_of(call.program, at), call.times, call.locals, frames_.size()};
  return true;
}

std::size_t Flow::program_of(int number, std::size_t place) const {
  constexpr int kFirstOfProbe = 9700, kLastOfProbe = 9999, kProbeOfHaas = 9023;
  if (const auto found = outline_.find(number)) return *found;
  if ((number >= kFirstOfProbe && number <= kLastOfProbe) || number == kProbeOfHaas)
    refuse(place, fmt::format("O{} is not in this file. Makers of probes have theirs from O9700 on, and a Haas has "
                              "O9023: {}. Another macro is "
                              "to be written behind the end of the main program",
                              number, gcode::kProbing));
  refuse(place, fmt::format("O{0} is not in this file, and no other is read; write O{0} ... M99 behind the end of the "
                            "main program, before the second %",
                            number));
}

/// Older controls have the number of times before the four digits of the program's number.
void Flow::call_subprogram(const Ordered& ordered) {
  constexpr int kBeyondShort = 10'000;
  int number = ordered.program, times = ordered.times;
  if (!ordered.times_are_said && number >= kBeyondShort) {
    const bool as_it_is = outline_.find(number).has_value();
    const bool with_times = outline_.find(number % kBeyondShort).has_value();
    if (as_it_is && with_times)
      refuse(ordered.place, fmt::format("P{0} may be O{0}, or O{1} {2} times; write P{0} L1, or P{1} L{2}", number,
                                        number % kBeyondShort, number / kBeyondShort));
    if (!as_it_is) times = number / kBeyondShort;
    if (!as_it_is) number %= kBeyondShort;
  }
  const std::size_t program = program_of(number, ordered.place);
  enter({Kind::Subprogram, program, outline_.programs()[program].begin}, times, ordered.place);
}

void Flow::call_local(const Ordered& ordered) {
  const std::size_t program = frames_.back().program;
  const auto spot = outline_.find_label(program, ordered.label.value(), next_);
  if (!spot) refuse_label(*ordered.label, this->program(), ordered.place);
  if (outline_.labels(program, *ordered.label) > 1)
    refuse(ordered.place, fmt::format("there is more than one N{} in {}, and which of them M97 calls, controls do not "
                                      "agree upon; give them numbers of their own",
                                      *ordered.label, name_of(this->program())));
  if (!outline_.loops_around(program, *spot).empty())
    refuse(ordered.place, fmt::format("N{} is within a loop; nothing jumps into a loop", *ordered.label));
  enter({Kind::Subprogram, program, *spot, {}, 0, {}, ordered.label}, ordered.times, ordered.place);
}

void Flow::call_macro(const MacroCall& call) {
  const std::size_t program = program_of(call.program, words_);
  enter({Kind::Macro, program, outline_.programs()[program].begin, {}, 0, call.locals}, call.times, words_);
}

void Flow::enter(Frame frame, int times, std::size_t place) {
  if (times == 0) return;
  const bool is_macro = frame.kind != Kind::Subprogram;
  if (is_macro && variables_.depth() == kDeepestMacros)
    refuse(place, fmt::format("a macro within {0} others; a control has {0}, too. Does it call itself without an end?",
                              kDeepestMacros));
  if (frames_.size() > kDeepestCalls)
    refuse(place, fmt::format("a call within {0} others; a control has {0}, too. Does it call itself without an end?",
                              kDeepestCalls));
  endless_.come_again(place);
  frame.back = next_;
  frame.more_times = times - 1;
  if (is_macro) variables_.enter(frame.given);
  next_ = frame.begin;
  frames_.push_back(std::move(frame));
}

void Flow::go_on(const Ordered& ordered, bool moved) {
  if (ordered.ends_modal_call) modal_.reset();
  const auto is_modal = [](const Frame& frame) { return frame.kind == Kind::Modal; };
  const bool calls = moved && modal_ && std::ranges::none_of(frames_, is_modal);
  if (calls && ordered.what != Ordered::What::Next)
    refuse(ordered.place, "M98 or M99 in a block whose move G66 calls a macro behind; write two blocks");
  if (calls)
    return enter({Kind::Modal, modal_->program, outline_.programs()[modal_->program].begin, {}, 0, modal_->locals},
                 modal_->times, words_);
  if (ordered.what == Ordered::What::Call) call_subprogram(ordered);
  if (ordered.what == Ordered::What::CallLocal) call_local(ordered);
  if (ordered.what == Ordered::What::Return) return_from(ordered);
}

void Flow::return_from(const Ordered& ordered) {
  if (frames_.size() == 1) {
    if (ordered.label) return go_to(*ordered.label, ordered.place);
    refuse(
        ordered.place,
        "M99 ends a program that M97, M98 or G65 called; here the main program came to it, which would begin anew for "
        "ever. End that with M30");
  }
  if (modal_ && modal_->frame == frames_.size()) modal_.reset();
  Frame& frame = frames_.back();
  if (frame.kind != Kind::Subprogram) {
    const Variables::Locals left = variables_.leave();
    if (frame.kind == Kind::Modal && modal_) modal_->locals = frame.given = left;
  }
  if (frame.more_times > 0 && !ordered.label) {
    endless_.come_again(ordered.place);
    --frame.more_times;
    if (frame.kind != Kind::Subprogram) variables_.enter(frame.given);
    frame.loops.clear();
    next_ = frame.begin;
    return;
  }
  next_ = frame.back;
  frames_.pop_back();
  if (ordered.label) go_to(*ordered.label, ordered.place);
}

std::string Flow::running() const {
  if (frames_.size() == 1) return {};
  const auto& label = frames_.back().label;
  return label ? fmt::format("N{}", *label) : fmt::format("O{}", program());
}

}  // namespace rmac::fanuc
