#include "clients/legacy/gcode/blocks/line.hpp"

#include <array>

#include "clients/legacy/gcode/blocks/refusal.hpp"

namespace rmac::gcode {

namespace {

/// What of a line's text a byte of its source becomes: nothing, itself, or its capital.
constexpr std::array<char, 256> kKept = [] {
  std::array<char, 256> kept{};
  for (std::size_t byte = 0; byte < kept.size(); ++byte) kept.at(byte) = static_cast<char>(byte);
  for (std::size_t letter = 'a'; letter <= 'z'; ++letter) kept.at(letter) = static_cast<char>(letter - 'a' + 'A');
  kept.at(' ') = kept.at('\t') = '\0';
  return kept;
}();

/// An end of line that other readers see and this one would not, and what stands for a comment in text().
bool is_unreadable(char letter) noexcept {
  return letter == '\r' || letter == Line::kComment || letter == '\0';
}

bool any_unreadable(std::string_view source) noexcept {
  bool any = false;
  for (const char letter : source) any |= is_unreadable(letter);  // without a way out: many bytes at once
  return any;
}

}  // namespace

void Line::read(std::string_view source, LineComments comments) {
  if (source.ends_with('\r')) source.remove_suffix(1);
  source_ = source;
  line_comments_ = comments;
  unreadable_ = std::string_view::npos;
  comments_.clear();
  text_.clear();
  if (any_unreadable(source)) {
    for (unreadable_ = 0; !is_unreadable(source[unreadable_]);) ++unreadable_;
    refuse(0, source[unreadable_] == '\r' ? "a carriage return within a line; end lines with LF or CR LF"
                                          : "a control character (1); take it out");
  }
  text_.resize(source.size());
  std::size_t end = 0;
  for (std::size_t at = 0; at < source.size(); ++at) {
    const char letter = kKept[static_cast<unsigned char>(source[at])];
    if (letter == '\0') continue;
    const bool is_comment = letter == '(' || (letter == ';' && comments == LineComments::Semicolon);
    text_[end] = is_comment ? kComment : letter;
    if (is_comment) read_comment(at, end);
    ++end;
  }
  text_.resize(end);
}

/// Of the comment that begins at `at` to its last byte. `end`: its place in the text.
void Line::read_comment(std::size_t& at, std::size_t end) {
  const std::size_t begin = at + 1;
  if (source_[at] == ';') {
    comments_.push_back(source_.substr(begin));
    at = source_.size();
    return;
  }
  at = source_.find_first_of("()", begin);
  if (at == std::string_view::npos) refuse(end, "this comment does not end on its line; close it with )");
  if (source_[at] == '(') refuse(end, "a comment within this comment; take the inner ( out");
  comments_.push_back(source_.substr(begin, at - begin));
}

std::size_t Line::column(std::size_t place) const noexcept {
  if (unreadable_ != std::string_view::npos) return unreadable_ + 1;
  for (std::size_t at = 0; at < source_.size(); ++at) {
    if (kKept[static_cast<unsigned char>(source_[at])] == '\0') continue;
    if (place-- == 0) return at + 1;
    if (source_[at] == ';' && line_comments_ == LineComments::Semicolon) break;
    if (source_[at] == '(') at = source_.find_first_of("()", at + 1);
    if (at == std::string_view::npos) break;
  }
  return source_.size() + 1;
}

}  // namespace rmac::gcode
