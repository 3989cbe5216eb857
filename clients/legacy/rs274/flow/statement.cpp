#include "clients/legacy/rs274/flow/statement.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "clients/legacy/gcode/blocks/comments.hpp"
#include "clients/legacy/rs274/blocks/refusal.hpp"
#include "clients/legacy/rs274/flow/label.hpp"

namespace rmac::rs274 {

namespace {

struct Word {
  std::string_view capitals, small;
  Keyword keyword;
};

// A word that another begins with stands behind it.
constexpr auto kWords = std::to_array<Word>({
    {"SUB", "sub", Keyword::Sub},
    {"ENDSUB", "endsub", Keyword::EndSub},
    {"CALL", "call", Keyword::Call},
    {"RETURN", "return", Keyword::Return},
    {"DO", "do", Keyword::Do},
    {"WHILE", "while", Keyword::While},
    {"ENDWHILE", "endwhile", Keyword::EndWhile},
    {"REPEAT", "repeat", Keyword::Repeat},
    {"ENDREPEAT", "endrepeat", Keyword::EndRepeat},
    {"IF", "if", Keyword::If},
    {"ELSEIF", "elseif", Keyword::ElseIf},
    {"ELSE", "else", Keyword::Else},
    {"ENDIF", "endif", Keyword::EndIf},
    {"BREAK", "break", Keyword::Break},
    {"CONTINUE", "continue", Keyword::Continue},
});

/// Those whose line goes on with a value in brackets, and those where it may.
constexpr bool needs_value(Keyword keyword) noexcept {
  return keyword == Keyword::While || keyword == Keyword::Repeat || keyword == Keyword::If ||
         keyword == Keyword::ElseIf;
}

constexpr bool may_have_value(Keyword keyword) noexcept {
  return keyword == Keyword::Call || keyword == Keyword::Return || keyword == Keyword::EndSub;
}

}  // namespace

std::string_view word_of(Keyword keyword) noexcept {
  if (keyword == Keyword::EndDo) return "while";
  const auto* found = std::ranges::find(kWords, keyword, &Word::keyword);
  return found == kWords.end() ? std::string_view("O") : found->small;
}

std::string name_of(std::string_view label) {
  if (label.find_first_not_of("0123456789") == std::string_view::npos) return fmt::format("o{}", label);
  std::string small(label);
  std::ranges::transform(small, small.begin(), [](char letter) {
    return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
  });
  return fmt::format("o<{}>", small);
}

std::string Statement::name() const {
  return computed ? "o" + label : name_of(label);
}

void require_end(std::string_view text, std::size_t at) {
  at = text.find_first_not_of(Line::kComment, at);
  if (at != std::string_view::npos)
    refuse(at, "nothing but a comment stands behind the O word of a line; write it in a line of its own");
}

Statement read_statement(const Line& line, std::size_t place) {
  const std::string_view text = line.text();
  refuse_active_comments(line);
  Statement statement;
  statement.place = place;
  std::size_t at = place + 1;
  auto label = read_label(text, at);
  statement.label = std::move(label.text);
  statement.computed = label.computed;
  const std::string_view rest = text.substr(at);
  const auto* word = std::ranges::find_if(kWords, [&](const Word& entry) { return rest.starts_with(entry.capitals); });
  if (word != kWords.end()) {
    statement.keyword = word->keyword;
    at += word->capitals.size();
  } else if (rest.find_first_not_of(Line::kComment) != std::string_view::npos) {
    refuse(at,
           fmt::format("{} is followed by sub, call, while, repeat, if or another word of its kind", statement.name()));
  }
  statement.arguments = at;
  const bool has_value = at < text.size() && text[at] == '[';
  if (needs_value(statement.keyword) && !has_value)
    refuse(at, fmt::format("{} is followed by a value in brackets", word_of(statement.keyword)));
  if (!needs_value(statement.keyword) && !may_have_value(statement.keyword)) require_end(text, at);
  return statement;
}

}  // namespace rmac::rs274
