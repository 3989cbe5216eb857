#include "clients/legacy/fanuc/flow/line_head.hpp"

#include <algorithm>
#include <charconv>

#include "clients/legacy/fanuc/blocks/refusal.hpp"
#include "clients/legacy/gcode/blocks/line.hpp"

namespace rmac::fanuc {

namespace {

constexpr std::string_view kDigits = "0123456789";

}  // namespace

std::optional<int> read_digits(std::string_view text, std::size_t& at) noexcept {
  constexpr std::size_t kMostDigits = 9;
  if (at >= text.size()) return std::nullopt;
  const std::size_t end = std::min(text.find_first_not_of(kDigits, at), text.size());
  if (end == at || end - at > kMostDigits) return std::nullopt;
  int number = 0;
  std::from_chars(text.data() + at, text.data() + end, number);
  at = end;
  return number;
}

LineHead read_head(std::string_view text) {
  LineHead head;
  std::size_t& at = head.behind;
  if (text.starts_with('/')) {
    head.deletes = true;
    ++at;
    const bool has_switch = at < text.size() && text[at] >= '1' && text[at] <= '9';
    if (has_switch) ++at;
  }
  if (at < text.size() && text[at] == 'N') {
    const std::size_t place = at++;
    head.number = read_digits(text, at);
    if (!head.number) refuse(place, "N has a number of 1 to 9 digits");
  }
  at = std::min(text.find_first_not_of(gcode::Line::kComment, at), text.size());
  return head;
}

}  // namespace rmac::fanuc
