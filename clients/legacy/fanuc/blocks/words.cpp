#include "clients/legacy/fanuc/blocks/words.hpp"

#include <fmt/format.h>

#include <cmath>

#include "clients/legacy/fanuc/blocks/grammar.hpp"
#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/gcode/blocks/line.hpp"
#include "clients/legacy/gcode/values/expression.hpp"

namespace rmac::fanuc {

namespace {

[[noreturn]] void refuse_letter(char letter, std::size_t place) {
  if (letter == ',')
    refuse(place,
           "corners that are rounded or chamfered by ,R and ,C are not taken; have the CAM program write them "
           "out as lines and arcs");
  if (letter == '/') refuse(place, "block delete in the midst of a block; write the block twice, one of them behind /");
  if (letter == '%') refuse(place, "% has a line of its own");
  if (letter == ':') refuse(place, "the number of a program begins its line");
  if (letter > ' ' && letter < '\x7f') refuse(place, fmt::format("a word begins with a letter, not with {}", letter));
  refuse(place, "a character that no program has");
}

}  // namespace

FanucWord read_word(std::string_view text, std::size_t& at, const Variables& variables, const gcode::Modes& modes) {
  const std::size_t place = at;
  const char letter = text[at++];
  if (letter < 'A' || letter > 'Z') refuse_letter(letter, place);
  if (letter == 'O') refuse(place, "the number of a program begins its line");
  if (letter == 'N') refuse(place, "a line's number stands at its begin");
  const std::size_t begin = at;
  const bool inch = modes.unit_mm && *modes.unit_mm != 1;
  const gcode::Maybe value = gcode::Expression(text, grammar_of_words(inch), variables).maybe(at);
  const std::string_view written = text.substr(begin, at - begin);
  const bool is_number = written.find_first_not_of("+-.0123456789") == std::string_view::npos;
  bool whole = is_number && written.find('.') == std::string_view::npos;
  if (letter == 'P' && value && !is_number) {
    whole = *value == std::round(*value);
    if (!whole) refuse(place, "P takes whole numbers; write ROUND or FIX around this value");
  }
  return {letter, {value.value_or(0), place, whole}, !value, !is_number};
}

void skip_comments(std::string_view text, std::size_t& at) {
  while (at < text.size() && text[at] == gcode::Line::kComment) ++at;
  if (at >= text.size() || text[at] != ';') return;
  const std::size_t place = at;
  at = text.find_first_not_of(std::string_view{";\x01", 2}, at);
  if (at != std::string_view::npos)
    refuse(place, "; ends a block; what stands behind it is another one, and is written into the next line");
  at = text.size();
}

void require_line_end(std::string_view text, std::size_t at) {
  skip_comments(text, at);
  if (at < text.size()) refuse(at, "nothing but a comment stands here; write the rest into a line of its own");
}

int integer_of(const gcode::Word& word, int least, int most, std::string_view meaning) {
  if (!(word.value >= least && word.value <= most) || word.value != std::round(word.value))
    refuse(word.place, fmt::format("{}: {} to {}", meaning, least, most));
  return static_cast<int>(word.value);
}

}  // namespace rmac::fanuc
