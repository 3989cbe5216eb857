#include "clients/legacy/rs274/flow/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// Blocks within blocks: what nests deeper is no program.
constexpr std::size_t kDeepestBlocks = 100;

/// Whether a line is a % or begins with O, with no more before it than / and N with its digits. Most lines are not, and
/// a million of them are to be passed in no time.
bool may_count(std::string_view line) noexcept {
  constexpr std::string_view kBefore = " \t/Nn0123456789.";
  const std::size_t at = line.find_first_not_of(kBefore);
  return at != std::string_view::npos && (line[at] == 'O' || line[at] == 'o' || line[at] == '%');
}

/// Where the O of a statement stands; none where a line is no statement.
std::optional<std::size_t> place_of_o(std::string_view text) noexcept {
  std::size_t at = text.starts_with('/') ? 1 : 0;
  if (text.substr(at).starts_with('N')) at = std::min(text.find_first_not_of("0123456789.", at + 1), text.size());
  return text.substr(at).starts_with('O') ? std::optional(at) : std::nullopt;
}

constexpr Keyword ending_of(Keyword opening) noexcept {
  switch (opening) {
    case Keyword::Sub:
      return Keyword::EndSub;
    case Keyword::Do:
      return Keyword::EndDo;
    case Keyword::While:
      return Keyword::EndWhile;
    case Keyword::Repeat:
      return Keyword::EndRepeat;
    default:
      return Keyword::EndIf;
  }
}

}  // namespace

Outline::Outline(std::string_view program, bool block_delete) {
  read(program, block_delete);
  open_.clear();
}

void Outline::read(std::string_view program, bool block_delete) {
  Line line;
  bool marked = false;
  for (std::size_t begin = 0, number = 1; begin < program.size(); ++number) {
    const std::size_t end = std::min(program.find('\n', begin), program.size() - 1) + 1;
    const std::string_view source = program.substr(begin, end - begin);
    const std::size_t here = std::exchange(begin, end);
    if (!may_count(source)) continue;
    try {
      line.read(source.substr(0, source.size() - (source.ends_with('\n') ? 1 : 0)));
      if (line.text().starts_with('%') && std::exchange(marked, true)) break;  // the end of the program
      const auto place = place_of_o(line.text());
      if (!place || (block_delete && line.text().starts_with('/'))) continue;
      Statement statement = read_statement(line, *place);
      statement.line = number;
      statement.begin = here;
      statement.end = end;
      add(std::move(statement));
    } catch (const Refusal& refusal) {
      if (!statements_.empty() && statements_.back().line == number) statements_.pop_back();
      trouble_ = Trouble{number, here, refusal.place, refusal.message};
      Statement statement;
      statement.keyword = Keyword::Trouble;
      statement.line = number;
      statements_.push_back(std::move(statement));
      return;
    }
  }
  if (open_.empty()) return;
  const Statement& last = around();
  trouble_ = Trouble{last.line, last.begin, last.place,
                     fmt::format("{0} {1} is not closed; write {0} {2} where it ends", last.name(),
                                 word_of(last.keyword), word_of(ending_of(last.keyword)))};
}

void Outline::add(Statement statement) {
  const std::size_t index = statements_.size();
  statements_.push_back(std::move(statement));
  Statement& added = statements_.back();
  switch (added.keyword) {
    case Keyword::Program:
    case Keyword::Sub:
      require_none_open(added);
      declare(index);
      if (added.keyword == Keyword::Sub) open_.push_back({index, index});
      return;
    case Keyword::While: {
      const bool ends_do = !open_.empty() && around().keyword == Keyword::Do && around().label == added.label;
      if (!ends_do) return open(index);
      added.keyword = Keyword::EndDo;
      return close(index, Keyword::Do);
    }
    case Keyword::Do:
    case Keyword::Repeat:
    case Keyword::If:
      return open(index);
    case Keyword::EndSub:
      return close(index, Keyword::Sub);
    case Keyword::EndWhile:
      return close(index, Keyword::While);
    case Keyword::EndRepeat:
      return close(index, Keyword::Repeat);
    case Keyword::EndIf:
    case Keyword::ElseIf:
    case Keyword::Else:
      return go_on_with_if(index);
    case Keyword::Break:
    case Keyword::Continue:
    case Keyword::Return:
      return leave(index);
    default:
      return;
  }
}

void Outline::require_none_open(const Statement& statement) const {
  if (open_.empty()) return;
  refuse(statement.place,
         fmt::format("{} {} within {} {} of line {}: it is defined outside of subs, loops and conditions",
                     statement.name(), word_of(statement.keyword), around().name(), word_of(around().keyword),
                     around().line));
}

void Outline::declare(std::size_t index) {
  const Statement& statement = statements_[index];
  if (statement.computed)
    refuse(statement.place, "what is called later has a number or a name here, not one that is computed");
  auto& declared = statement.keyword == Keyword::Sub ? subs_ : programs_;
  const auto [there, is_new] = declared.emplace(statement.label, index);
  if (!is_new)
    refuse(statement.place, fmt::format("{} is defined in line {} already; give one of them another label",
                                        statement.name(), statements_[there->second].line));
}

void Outline::open(std::size_t index) {
  const Statement& statement = statements_[index];
  if (open_.size() == kDeepestBlocks)
    refuse(statement.place, fmt::format("blocks nested more than {} deep", kDeepestBlocks));
  for (const Block& block : open_) {
    const Statement& outer = statements_[block.begin];
    if (outer.label == statement.label && outer.keyword != Keyword::Sub)
      refuse(statement.place, fmt::format("{} of line {} is not closed yet; give the inner one another label",
                                          statement.name(), outer.line));
  }
  open_.push_back({index, index});
}

/// The innermost block that is open has to be of this kind and label.
void Outline::require_innermost(std::size_t index, Keyword opening) const {
  const Statement& statement = statements_[index];
  if (open_.empty())
    refuse(statement.place,
           fmt::format("{} {}, and no {} is open", statement.name(), word_of(statement.keyword), word_of(opening)));
  if (around().keyword != opening || around().label != statement.label)
    refuse(statement.place,
           fmt::format("{} {} does not belong to the innermost block that is open, {} {} of line {}", statement.name(),
                       word_of(statement.keyword), around().name(), word_of(around().keyword), around().line));
}

void Outline::close(std::size_t index, Keyword opening) {
  require_innermost(index, opening);
  const std::size_t begin = open_.back().begin;
  open_.pop_back();
  statements_[begin].ending = index;
  statements_[index].opening = begin;
}

void Outline::go_on_with_if(std::size_t index) {
  require_innermost(index, Keyword::If);
  Block& block = open_.back();
  Statement &statement = statements_[index], &before = statements_[block.last];
  if (before.keyword == Keyword::Else && statement.keyword != Keyword::EndIf)
    refuse(statement.place,
           fmt::format("{} {} behind its else of line {}", statement.name(), word_of(statement.keyword), before.line));
  before.branch = block.last = index;
  if (statement.keyword != Keyword::EndIf) return;
  for (std::size_t part = block.begin; part != index; part = statements_[part].branch) {
    statements_[part].ending = index;
  }
  open_.pop_back();
}

/// break and continue: of the block around them that has their label; return: of the sub around it.
void Outline::leave(std::size_t index) {
  Statement& statement = statements_[index];
  const bool of_sub = statement.keyword == Keyword::Return;
  for (auto block = open_.rbegin(); block != open_.rend(); ++block) {
    const Statement& outer = statements_[block->begin];
    const bool is_sub = outer.keyword == Keyword::Sub;
    // LinuxCNC has each return leave the sub around it, whatever its label.
    if (is_sub == of_sub && (of_sub || outer.label == statement.label)) {
      if (outer.keyword == Keyword::Repeat || outer.keyword == Keyword::If)
        refuse(statement.place, fmt::format("{} of {} {}: it is for while and do, as in LinuxCNC",
                                            word_of(statement.keyword), outer.name(), word_of(outer.keyword)));
      statement.opening = block->begin;
      return;
    }
    if (is_sub) break;
  }
  refuse(statement.place, fmt::format("{} {} stands in no {}", statement.name(), word_of(statement.keyword),
                                      of_sub ? "sub" : "while or do of this label"));
}

std::optional<std::size_t> Outline::find(const std::string& label, bool numbered) const {
  const auto& declared = numbered ? programs_ : subs_;
  const auto found = declared.find(label);
  return found == declared.end() ? std::nullopt : std::optional(found->second);
}

}  // namespace rmac::rs274
