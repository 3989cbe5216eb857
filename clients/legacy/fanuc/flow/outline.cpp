#include "clients/legacy/fanuc/flow/outline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/fanuc/flow/line_head.hpp"

namespace rmac::fanuc {

namespace {

/// A control has this many loops within each other, with these numbers.
constexpr int kMostLoops = 3;

/// Whether a line may begin a program, begin or end a loop, or be a %, also behind comments. Most lines do not, and a
/// million of them are to be passed in no time.
bool may_be_of_outline(std::string_view line) noexcept {
  constexpr std::string_view kHead = " \t/Nn0123456789";
  std::size_t at = line.find_first_not_of(kHead);
  while (at != std::string_view::npos && line[at] == '(') {
    const std::size_t close = line.find(')', at);
    at = close == std::string_view::npos ? close : line.find_first_not_of(kHead, close + 1);
  }
  return at != std::string_view::npos && std::string_view("OoWwDdEe:%").find(line[at]) != std::string_view::npos;
}

/// Behind WHILE's condition, where DO stands.
std::size_t behind_brackets(std::string_view text, std::size_t at) {
  const std::size_t place = at;
  std::size_t depth = 0;
  do {
    if (at >= text.size()) refuse(place, "this bracket is not closed");
    if (text[at] == '[') ++depth;
    if (text[at] == ']') --depth;
    ++at;
  } while (depth > 0);
  return at;
}

int loop_number(std::string_view text, std::size_t at) {
  const std::size_t place = at;
  const auto number = read_digits(text, at);
  if (!number || *number < 1 || *number > kMostLoops) refuse(place, "a loop has the number 1, 2 or 3");
  return *number;
}

}  // namespace

Outline::Outline(std::string_view text) : text_(text) {
  read(text);
  open_.clear();
}

void Outline::read(std::string_view text) {
  gcode::Line line;
  bool marked = false;
  programs_.push_back({});
  Spot spot;
  for (; spot.at < text.size();) {
    const std::size_t end = std::min(text.find('\n', spot.at), text.size() - 1) + 1;
    std::string_view source = text.substr(spot.at, end - spot.at);
    if (source.ends_with('\n')) source.remove_suffix(1);
    const Spot here = std::exchange(spot, {end, spot.lines + 1});
    if (!may_be_of_outline(source)) continue;
    try {
      line.read(source, gcode::LineComments::None);
      const std::string_view words = line.text();
      const LineHead head = read_head(words);
      const std::size_t at = head.behind;
      const std::string_view rest = words.substr(at);
      // Behind a / it may be left out, and what follows it carried out.
      if (rest.starts_with('%') && !head.deletes && std::exchange(marked, true)) break;
      if (rest.starts_with('O') || rest.starts_with(':')) begin_program(line, at, here);
      if (rest.starts_with("WHILE") || rest.starts_with("DO")) begin_loop(line, at, here, spot);
      if (rest.starts_with("END")) end_loop(line, at, spot);
    } catch (const Refusal& refusal) {
      trouble_ = Trouble{here, refusal.place, refusal.message};
      return;
    }
  }
  programs_.back().end = spot;
  try {
    require_loops_ended();
  } catch (const Refusal& refusal) {
    trouble_ = Trouble{loops_[open_.back()].begin, refusal.place, refusal.message};
  }
}

void Outline::begin_program(const gcode::Line& line, std::size_t place, const Spot& spot) {
  require_loops_ended();
  std::size_t at = place + 1;
  const auto number = read_digits(line.text(), at);
  if (!number) refuse(place, "a program's number is O and 1 to 9 digits");
  programs_.back().end = spot;
  programs_.push_back({*number, spot, {}});
  if (!by_number_.emplace(*number, programs_.size() - 1).second)
    refuse(place, fmt::format("O{} begins a second time; each program has a number of its own", *number));
}

void Outline::begin_loop(const gcode::Line& line, std::size_t place, const Spot& spot, const Spot& behind) {
  constexpr std::size_t kWhile = 5, kDo = 2;
  const std::string_view text = line.text();
  std::size_t at = place;
  if (text.substr(at).starts_with("WHILE")) {
    at += kWhile;
    if (!text.substr(at).starts_with('[')) refuse(at, "WHILE has its condition in [ ]");
    at = behind_brackets(text, at);
    if (!text.substr(at).starts_with("DO")) refuse(at, "DO and a number stand behind the condition of WHILE");
  }
  const int number = loop_number(text, at + kDo);
  for (const std::size_t around : open_) {
    if (loops_[around].number == number)
      refuse(at, fmt::format("DO{0} within DO{0}, which no END{0} ended; give it another number, 1 to {1}", number,
                             kMostLoops));
  }
  open_.push_back(loops_.size());
  loop_at_.emplace(spot, loops_.size());
  loops_.push_back({programs_.size() - 1, number, spot, behind, {}});
}

void Outline::end_loop(const gcode::Line& line, std::size_t place, const Spot& behind) {
  constexpr std::size_t kEnd = 3;
  const std::string_view text = line.text();
  const int number = loop_number(text, place + kEnd);
  if (open_.empty()) refuse(place, fmt::format("END{0} without a DO{0} before it", number));
  Loop& loop = loops_[open_.back()];
  if (loop.number != number)
    refuse(place, fmt::format("END{} where END{} is due: loops do not cross each other", number, loop.number));
  loop.end = behind;
  open_.pop_back();
}

void Outline::require_loops_ended() const {
  if (!open_.empty())
    refuse(0, fmt::format("DO{0} is not ended; write END{0} before the program's end", loops_[open_.back()].number));
}

std::optional<std::size_t> Outline::find(int number) const {
  const auto found = by_number_.find(number);
  return found == by_number_.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::size_t> Outline::loop_at(const Spot& spot) const {
  const auto found = loop_at_.find(spot);
  return found == loop_at_.end() ? std::nullopt : std::optional(found->second);
}

std::vector<std::size_t> Outline::loops_around(std::size_t program, const Spot& spot) const {
  std::vector<std::size_t> around;
  for (std::size_t index = 0; index < loops_.size(); ++index) {
    const Loop& loop = loops_[index];
    if (loop.program == program && loop.begin < spot && spot < loop.end) around.push_back(index);
  }
  return around;
}

const std::multimap<int, Spot>& Outline::labels_of(std::size_t program) {
  auto [entry, is_new] = labels_.try_emplace(program);
  auto& labels = entry->second;
  if (is_new) {
    for (Spot spot = programs_[program].begin; spot < programs_[program].end; ++spot.lines) {
      std::string head;
      const std::size_t end = std::min(text_.find('\n', spot.at), text_.size() - 1) + 1;
      for (const char letter : text_.substr(spot.at, end - spot.at)) {
        if (letter == ' ' || letter == '\t') continue;
        if (std::string_view("/Nn0123456789").find(letter) == std::string_view::npos) break;
        head += letter == 'n' ? 'N' : letter;
      }
      const std::size_t begin = head.find('N');
      std::size_t at = begin + 1;
      const auto number = begin == std::string::npos ? std::nullopt : read_digits(head, at);
      if (number) labels.emplace(*number, spot);
      spot.at = end;
    }
  }
  return labels;
}

std::optional<Spot> Outline::find_label(std::size_t program, int label, const Spot& from) {
  const auto [first, last] = labels_of(program).equal_range(label);
  if (first == last) return std::nullopt;
  const auto behind = std::find_if(first, last, [&from](const auto& found) { return from <= found.second; });
  return (behind == last ? first : behind)->second;
}

}  // namespace rmac::fanuc
