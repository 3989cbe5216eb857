#include "clients/legacy/apt/statements/scanner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "clients/legacy/apt/statements/refusal.hpp"

namespace rmac::apt {

namespace {

constexpr int kDeepest = 8;
constexpr std::string_view kBlanks = " \t\r\f\v\x1a";

bool is_blank(char letter) {
  return kBlanks.find(letter) != std::string_view::npos;
}
bool is_digit(char letter) {
  return letter >= '0' && letter <= '9';
}
bool is_letter(char letter) {
  return (letter >= 'A' && letter <= 'Z') || letter == '_';
}
char capital(char letter) {
  return letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
}

std::string_view trimmed(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(kBlanks);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlanks) - begin + 1);
}

/// A statement whose rest is text. Without a slash the text ends with its line, whatever it holds.
struct TextWord {
  std::string_view word;
  bool has_slash;
};
constexpr std::array<TextWord, 12> kTextWords{{{"PARTNO", false},
                                               {"PPRINT", false},
                                               {"REMARK", false},
                                               {"INSERT", false},
                                               {"LETTER", false},
                                               {"TITLES", false},
                                               {"DISPLY", false},
                                               {"TPRINT", true},
                                               {"MACHIN", true},
                                               {"TLDATA", true},
                                               {"PAINT", true},
                                               {"TOOLPATH", true}}};

/// Where the word ends in the line, blanks in it or not; npos where the line does not begin with it.
std::size_t end_of_word(std::string_view line, std::string_view word) {
  std::size_t at = 0;
  for (const char wanted : word) {
    while (at < line.size() && is_blank(line[at])) ++at;
    if (at == line.size() || capital(line[at]) != wanted) return std::string_view::npos;
    ++at;
  }
  return at;
}

}  // namespace

bool Scanner::take_line() {
  if (taken_ >= program_.size()) return false;
  begin_ = taken_;
  const std::size_t end = std::min(program_.find('\n', taken_), program_.size());
  source_ = program_.substr(begin_, end - begin_);
  taken_ = end + 1;
  ++line_;
  return true;
}

bool Scanner::next(Statement& statement) {
  while (take_line()) {
    const std::string_view text = trimmed(source_);
    if (text.empty()) continue;
    statement.line = line_;
    statement.place = begin_ + static_cast<std::size_t>(text.data() - source_.data());
    statement.name.clear();
    statement.text.clear();
    statement.elements.clear();
    statement.is_text = take_text(statement);
    if (statement.is_text) return true;
    take_letters();
    read_head(statement);
    return true;
  }
  return false;
}

bool Scanner::take_text(Statement& statement) {
  const std::string_view line = trimmed(source_);
  if (line.starts_with("$$")) {
    statement.major = "$$";
    statement.text = trimmed(line.substr(2));
    // Creo tells things in comments of this form, which go on as statements do.
    if (statement.text.starts_with("->")) go_on(statement);
    return true;
  }
  for (const auto& [word, has_slash] : kTextWords) {
    const std::size_t end = end_of_word(line, word);
    if (end == std::string_view::npos) continue;
    std::string_view text = trimmed(line.substr(end));
    if (has_slash && !text.starts_with('/')) continue;
    if (text.starts_with('/')) text = trimmed(text.substr(1));
    statement.major = word;
    statement.text = text;
    if (has_slash) go_on(statement);
    return true;
  }
  return false;
}

void Scanner::go_on(Statement& statement) {
  while (statement.text.ends_with('$')) {
    statement.text.pop_back();
    if (!take_line()) refuse(statement.place, "the statement goes on ($), but the program ends");
    statement.text += trimmed(source_);
  }
}

/// All of a statement, over its lines.
void Scanner::take_letters() {
  letters_.clear();
  at_ = 0;
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (std::size_t column = 0; column < source_.size(); ++column) {
      const char letter = source_[column];
      if (letter == '$') {
        // Behind the one that goes on stands a comment, as behind two.
        goes_on = column + 1 == source_.size() || source_[column + 1] != '$' || column == 0 ||
                  trimmed(source_.substr(0, column)).empty();
        break;
      }
      if (!is_blank(letter)) letters_.push_back({capital(letter), begin_ + column});
    }
    end_ = begin_ + source_.size();
    if (goes_on && !take_line()) refuse(end_, "the statement goes on ($), but the program ends; it may be cut off");
  }
}

std::string Scanner::read_word() {
  std::string word;
  while (is_letter(here()) || is_digit(here()) ||
         (here() == '-' && at_ + 1 < letters_.size() && is_letter(letters_[at_ + 1].letter))) {
    word += letters_[at_++].letter;
  }
  return word;
}

/// Words before the slash, with the commas between them.
std::string Scanner::read_majors() {
  std::string majors;
  while (true) {
    if (!is_letter(here())) {
      refuse(place(), here() == ';' ? "; is not taken; write each statement on a line of its own"
                                    : "a statement begins with a word, as in GOTO/1,2,3");
    }
    majors += read_word();
    if (here() != ',') return majors;
    majors += ',';
    ++at_;
  }
}

void Scanner::read_head(Statement& statement) {
  if (at_ == letters_.size()) refuse(statement.place, "a statement of which nothing but $ is there");
  statement.major = read_majors();
  if (here() == ')' || here() == '=') {
    const bool is_label = here() == ')';
    ++at_;
    // A label names the place for jumps, which are not taken.
    if (!is_label) statement.name = statement.major;
    statement.place = place();
    statement.major = read_majors();
  }
  if (here() == '/') {
    ++at_;
    read_elements(statement.elements, 0);
    // `RAPID/` is RAPID.
    if (statement.elements.size() == 1 && statement.elements.front().kind == Element::Kind::Empty)
      statement.elements.clear();
  }
  if (at_ < letters_.size()) {
    refuse(place(), fmt::format("{} is not understood here; elements of a statement have commas between them, and a "
                                "major word has a / behind it",
                                here() >= ' ' && here() <= '~' ? std::string(1, here()) : "this character"));
  }
}

void Scanner::read_elements(std::vector<Element>& elements, int depth) {
  while (true) {
    read_element(elements.emplace_back(), depth);
    if (here() != ',') return;
    ++at_;
  }
}

void Scanner::read_element(Element& element, int depth) {
  element.place = place();
  if (is_letter(here())) {
    element.kind = Element::Kind::Word;
    element.word = read_word();
    if (here() != '=') return;
    ++at_;
    if (depth == kDeepest) refuse(element.place, "this is nested too deep");
    element.kind = Element::Kind::Assigned;
    read_element(element.inner.emplace_back(), depth + 1);
  } else if (here() == '(') {
    read_group(element, depth);
  } else if (is_digit(here()) || here() == '.' || here() == '+' || here() == '-') {
    read_number(element);
  }
}

void Scanner::read_group(Element& group, int depth) {
  if (depth == kDeepest) refuse(group.place, "this is nested too deep");
  ++at_;
  group.kind = Element::Kind::Group;
  group.word = read_majors();
  if (here() == '/') {
    ++at_;
    read_elements(group.inner, depth + 1);
  }
  if (here() != ')') refuse(place(), "a ) is missing here");
  ++at_;
}

void Scanner::read_number(Element& element) {
  element.kind = Element::Kind::Number;
  std::string digits;
  const bool negative = here() == '-';
  if (negative || here() == '+') ++at_;
  const std::size_t first = at_;
  const auto take = [&](auto&& is_part) {
    while (is_part(here())) {
      if (at_ > first && letters_[at_].place != letters_[at_ - 1].place + 1)
        refuse(place(), "a blank within a number; a comma may be missing");
      digits += letters_[at_++].letter;
    }
  };
  take([](char letter) { return is_digit(letter) || letter == '.'; });
  if (here() == 'E' && at_ > first) {
    digits += letters_[at_++].letter;
    if (here() == '+' || here() == '-') digits += letters_[at_++].letter;
    take(is_digit);
  }
  const auto read = std::from_chars(digits.data(), digits.data() + digits.size(), element.value);
  if (read.ec != std::errc() || read.ptr != digits.data() + digits.size() || !std::isfinite(element.value)) {
    refuse(element.place, "this is no number; numbers are written as 1, -1.5, .5 or 1.5E-3");
  }
  if (negative) element.value = -element.value;
}

}  // namespace rmac::apt
