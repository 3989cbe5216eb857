#include "clients/legacy/fanuc/blocks/arguments.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "clients/legacy/fanuc/blocks/refusal.hpp"

namespace rmac::fanuc {

namespace {

constexpr int kMostMacro = 99'999'999, kMostCalls = 9999;

/// Of the letters from A on: the variable that each sets; 0 of those that set none, and of I, J and K, which are of
/// sets.
constexpr std::array<int, 26> kVariableOf{1, 2, 3, 7,  8,  9,  0,  11, 0,  0,  0,  0,  13,
                                          0, 0, 0, 17, 18, 19, 20, 21, 22, 23, 24, 25, 26};

/// I, J and K: in this order they are a set; one that goes back begins the next.
class Sets {
 public:
  int variable_of(char letter) noexcept {
    const int place = letter - 'I';
    if (place <= last_) ++set_;
    last_ = place;
    return 4 + 3 * set_ + place;
  }

 private:
  int set_ = 0, last_ = -1;
};

double argument_of(const FanucWord& word, const gcode::Modes& modes) {
  static constexpr std::string_view kCounts = "DHMST";
  const bool counts = kCounts.find(word.letter) != std::string_view::npos;
  const bool metric = modes.unit_mm == 1;
  if (counts || (word.letter == 'F' && metric)) return word.word.value;
  return modes.number(word.word, metric ? gcode::Modes::kIncrement : gcode::Modes::kIncrement / 10);
}

}  // namespace

MacroCall read_macro_call(std::string_view text, std::size_t at, const Variables& variables,
                          const gcode::Modes& modes) {
  MacroCall call;
  call.place = at;
  std::optional<int> program;
  std::array<bool, 26> given{};
  Sets sets;
  for (skip_comments(text, at); at < text.size(); skip_comments(text, at)) {
    const FanucWord word = read_word(text, at, variables, modes);
    const std::size_t place = word.word.place;
    const bool of_sets = word.letter >= 'I' && word.letter <= 'K';
    bool& before = given.at(static_cast<std::size_t>(word.letter - 'A'));
    if (before && !of_sets) refuse(place, fmt::format("two {} words in one call", word.letter));
    before = true;
    if (word.letter == 'P') {
      program = integer_of(word.word, 1, kMostMacro, "P is the number of the macro");
      continue;
    }
    if (word.letter == 'L') {
      call.times = integer_of(word.word, 1, kMostCalls, "L says how often the macro is called");
      continue;
    }
    if (word.letter == 'G') refuse(place, "another G code beside G65 or G66; write it into a block of its own");
    const int number =
        of_sets ? sets.variable_of(word.letter) : kVariableOf.at(static_cast<std::size_t>(word.letter - 'A'));
    if (number > Variables::kLocals) refuse(place, "more than ten sets of I, J and K");
    if (!word.vacant) call.locals.at(static_cast<std::size_t>(number)) = argument_of(word, modes);
  }
  if (!program) refuse(call.place, "G65 and G66 need P, the number of the macro");
  call.program = *program;
  return call;
}

}  // namespace rmac::fanuc
