#include "clients/legacy/gcode/blocks/comments.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

std::string capitals(std::string_view text) {
  std::string result;
  for (const char letter : text) {
    if (letter != ' ' && letter != '\t')
      result += letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter;
  }
  return result;
}

}  // namespace

void refuse_active_comments(const Line& line) {
  static constexpr std::array<std::string_view, 2> kWords{"PROBEOPEN", "PROBECLOSE"};
  for (const std::string_view comment : line.comments()) {
    const std::string text = capitals(comment);
    const auto begins = [&text](std::string_view word) { return text.starts_with(word); };
    if (const auto* const word = std::ranges::find_if(kWords, begins); word != kWords.end())
      refuse(line.text().find(Line::kComment),
             fmt::format("({} has a control record what it probes; take it out", *word));
  }
}

std::optional<std::string_view> message_of(std::string_view comment) {
  const std::size_t comma = comment.find(',');
  if (comma == std::string_view::npos || capitals(comment.substr(0, comma)) != "MSG") return std::nullopt;
  return comment.substr(comma + 1);
}

}  // namespace rmac::gcode
