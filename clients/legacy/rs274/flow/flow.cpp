#include "clients/legacy/rs274/flow/flow.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clients/legacy/gcode/values/expression.hpp"
#include "clients/legacy/rs274/blocks/grammar.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/label.hpp"

namespace rmac::rs274 {

namespace {

/// Of LinuxCNC's ten levels the program itself is the first.
constexpr std::size_t kDeepestCalls = 9;

}  // namespace

Flow::Flow(std::string_view program, bool block_delete, Bounds bounds, Parameters& parameters, Asked asked)
    : sources_(program, block_delete, std::move(asked.find_file)),
      parameters_(parameters),
      endless_(bounds, std::move(asked.made)),
      leaving_(std::move(asked.leaving)),
      next_{&sources_.program()},
      read_from_(next_.source) {}

bool Flow::next() {
  while (next_.at < next_.source->text.size()) {
    read_line();
    const auto& statements = next_.source->outline.statements();
    if (next_.statement == statements.size() || statements[next_.statement].line != number_) return true;
    carry_out(next_.statement++);
  }
  return false;
}

void Flow::read_line() {
  read_from_ = next_.source;
  const std::string_view text = next_.source->text;
  const std::size_t end = std::min(text.find('\n', next_.at), text.size());
  const std::string_view line = text.substr(next_.at, end - next_.at);
  next_.at = std::min(end + 1, text.size());
  number_ = ++next_.lines;
  if (read_from_ == &sources_.program()) furthest_ = std::max(furthest_, number_);
  endless_.count();
  line_.read(line);
}

void Flow::carry_out(std::size_t index) {
  const Statement& statement = at(index);
  switch (statement.keyword) {
    case Keyword::Program:
      if (!calls_.empty())
        refuse(statement.place,
               fmt::format("{} begins here while {} runs; end that with M99", statement.name(), running()));
      return;
    case Keyword::Sub:
      require_whole(*next_.source, index);
      return go_behind(statement.ending);
    case Keyword::Call:
      return call_sub(statement);
    case Keyword::EndSub:
    case Keyword::Return:
      return return_from_sub(statement);
    case Keyword::While:
      require_whole(*next_.source, index);
      if (value(statement) == 0) go_behind(statement.ending);
      return;
    case Keyword::EndWhile:
      endless_.come_again(statement.place);
      return go_before(statement.opening);
    case Keyword::Do:
      return require_whole(*next_.source, index);
    case Keyword::EndDo:
      if (value(statement) == 0) return;
      endless_.come_again(statement.place);
      return go_behind(statement.opening);
    case Keyword::Repeat:
      return begin_repeat(index);
    case Keyword::EndRepeat:
      return end_repeat(index);
    case Keyword::If:
      require_whole(*next_.source, index);
      if (value(statement) == 0) go_to_branch(index);
      return;
    case Keyword::ElseIf:
    case Keyword::Else:
      return go_behind(statement.ending);
    case Keyword::EndIf:
      return;
    case Keyword::Break:
    case Keyword::Continue:
      return leave_loop(statement);
    case Keyword::Trouble:
      refuse_trouble(*next_.source);
  }
}

/// From an `if` that does not hold to the part of it that does.
void Flow::go_to_branch(std::size_t index) {
  for (std::size_t part = at(index).branch;; part = at(part).branch) {
    go_before(part);
    read_line();
    next_.statement = part + 1;
    if (at(part).keyword != Keyword::ElseIf || value(at(part)) != 0) return;
  }
}

void Flow::begin_repeat(std::size_t index) {
  const Statement& statement = at(index);
  require_whole(*next_.source, index);
  const double times = std::nearbyint(value(statement));  // a half to the even side, as LinuxCNC
  if (times < 1) return go_behind(statement.ending);
  repeats_.push_back({index, times - 1});
}

void Flow::end_repeat(std::size_t index) {
  const Statement& statement = at(index);
  if (repeats_.back().more_times < 1) return repeats_.pop_back();
  endless_.come_again(statement.place);
  repeats_.back().more_times -= 1;
  go_behind(statement.opening);
}

/// Repeats within the loop are left with it.
void Flow::leave_loop(const Statement& statement) {
  const Statement& opening = at(statement.opening);
  const std::size_t of_callers = calls_.empty() ? 0 : calls_.back().repeats;
  while (repeats_.size() > of_callers && repeats_.back().statement > statement.opening) repeats_.pop_back();
  if (statement.keyword == Keyword::Break) return go_behind(opening.ending);
  if (opening.keyword == Keyword::Do) return go_before(opening.ending);
  endless_.come_again(statement.place);
  go_before(statement.opening);
}

void Flow::call_sub(const Statement& statement) {
  const std::string_view text = line_.text();
  const std::string label =
      statement.computed ? computed_label(text, statement.place + 1, parameters_) : statement.label;
  const Callee sub = find(label, false, statement.place);
  require_whole(*sub.source, sub.statement);
  const Parameters::Arguments given = arguments(statement);
  enter(sub, 0, statement.place);
  parameters_.enter(given);
}

void Flow::call(int label, int times, std::size_t place) {
  const Callee program = find(fmt::format("{}", label), true, place);
  if (times == 0) return;
  enter(program, times - 1, place);
  parameters_.enter(std::nullopt);
}

void Flow::enter(const Callee& callee, int more_times, std::size_t place) {
  if (calls_.size() == kDeepestCalls)
    refuse(place, fmt::format("a call within {0} others; LinuxCNC has {0}, too. Does it call itself without an end?",
                              kDeepestCalls));
  endless_.come_again(place);
  calls_.push_back({callee.statement, next_, more_times, repeats_.size()});
  next_.source = callee.source;
  go_behind(callee.statement);
}

void Flow::return_from_sub(const Statement& statement) {
  const bool has_value = line_.text().substr(statement.arguments).starts_with('[');
  if (!has_value) require_end(line_.text(), statement.arguments);
  parameters_.returned(has_value ? std::optional(value(statement)) : std::nullopt);
  leave_call(statement.place);
}

void Flow::leave_call(std::size_t place) {
  if (leaving_) leaving_(place);
  parameters_.leave();
  repeats_.resize(calls_.back().repeats);
  next_ = calls_.back().back;
  calls_.pop_back();
}

void Flow::end_of_numbered(std::size_t place) {
  if (calls_.empty())
    refuse(place,
           "M99 ends a numbered program that M98 called; here the main program came to it, which would begin anew "
           "for ever. End that with M2 or M30");
  Call& running = calls_.back();
  if (at(running.statement).keyword != Keyword::Program)
    refuse(place, "M99 ends a numbered program; a sub ends with endsub or return");
  if (running.more_times == 0) return leave_call(place);
  if (leaving_) leaving_(place);
  endless_.come_again(place);
  --running.more_times;
  parameters_.leave();
  parameters_.enter(std::nullopt);
  repeats_.resize(running.repeats);
  go_behind(running.statement);
}

std::string Flow::running() const {
  return calls_.empty() ? std::string() : at(calls_.back().statement).name();
}

double Flow::value(const Statement& statement) const {
  std::size_t at = statement.arguments;
  const double result = gcode::Expression(line_.text(), grammar(), parameters_).value(at);
  require_end(line_.text(), at);
  return result;
}

Parameters::Arguments Flow::arguments(const Statement& statement) const {
  const std::string_view text = line_.text();
  Parameters::Arguments result{};
  std::size_t count = 0, at = statement.arguments;
  gcode::Expression expression(text, grammar(), parameters_);
  for (; at < text.size() && (text[at] == '[' || text[at] == Line::kComment);) {
    if (text[at] == Line::kComment) {
      ++at;
      continue;
    }
    if (count == result.size()) refuse(at, fmt::format("a call has at most {} values", result.size()));
    result.at(count++) = expression.value(at);
  }
  require_end(text, at);
  return result;
}

void Flow::go_before(std::size_t statement) {
  next_ = {next_.source, at(statement).begin, at(statement).line - 1, statement};
}

void Flow::go_behind(std::size_t statement) {
  next_ = {next_.source, at(statement).end, at(statement).line, statement + 1};
}

/// A block is entered only where all of it is understood.
void Flow::require_whole(const Source& source, std::size_t statement) {
  if (source.outline.statements()[statement].ending == Statement::kNone) refuse_trouble(source);
}

void Flow::refuse_trouble(const Source& source) {
  const Outline::Trouble& trouble = *source.outline.trouble();
  next_ = {&source, trouble.begin, trouble.line - 1, 0};
  read_line();
  refuse(trouble.place, trouble.message);
}

}  // namespace rmac::rs274
