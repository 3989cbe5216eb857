#include "clients/legacy/rs274/blocks/comments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// What stands before the comma of a comment, without spaces and in capitals; nothing where it has no comma.
std::string word_before_comma(std::string_view comment) {
  const std::size_t comma = comment.find(',');
  std::string result;
  if (comma == std::string_view::npos) return result;
  for (const char letter : comment.substr(0, comma)) {
    if (letter != ' ' && letter != '\t')
      result += letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  }
  return result;
}

}  // namespace

void refuse_active_comments(const Line& line) {
  static constexpr std::array<std::string_view, 8> kWords{"DEBUG",     "PRINT",    "LOG",       "LOGOPEN",
                                                          "LOGAPPEND", "LOGCLOSE", "PROBEOPEN", "PROBECLOSE"};
  for (const std::string_view comment : line.comments()) {
    const std::string word = word_before_comma(comment);
    if (std::ranges::find(kWords, word) != kWords.end())
      refuse(line.text().find(Line::kComment),
             fmt::format("({}, … has a control do something that no .rmac can; take it out", word));
  }
}

std::optional<std::string_view> message_of(std::string_view comment) {
  if (word_before_comma(comment) != "MSG") return std::nullopt;
  return comment.substr(comment.find(',') + 1);
}

}  // namespace rmac::rs274
