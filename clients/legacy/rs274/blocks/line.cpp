#include "clients/legacy/rs274/blocks/line.hpp"

#include "clients/legacy/rs274/blocks/refusal.hpp"

namespace rmac::rs274 {

namespace {

/// An end of line that other readers see and this one would not, and what stands for a comment in text().
constexpr char kNoText[] = {'\r', Line::kComment, '\0'};

}  // namespace

void Line::keep(char letter, std::size_t column) {
  text_.push_back(letter);
  columns_.push_back(column);
}

void Line::read(std::string_view source) {
  text_.clear();
  columns_.clear();
  comments_.clear();
  end_ = source.size() + 1;
  if (source.ends_with('\r')) source.remove_suffix(1);
  if (const std::size_t at = source.find_first_of(kNoText); at != std::string_view::npos) {
    columns_.push_back(at + 1);
    refuse(0, source[at] == '\r' ? "a carriage return within a line; end lines with LF or CR LF"
                                 : "a control character (1); take it out");
  }
  for (std::size_t at = 0; at < source.size(); ++at) {
    const char letter = source[at];
    if (letter == ' ' || letter == '\t') continue;
    if (letter == ';') {
      keep(kComment, at + 1);
      comments_.push_back(source.substr(at + 1));
      return;
    }
    if (letter == '(') {
      keep(kComment, at + 1);
      const std::size_t end = source.find_first_of("()", at + 1);
      if (end == std::string_view::npos)
        refuse(text_.size() - 1, "this comment does not end on its line; close it with )");
      if (source[end] == '(') refuse(text_.size() - 1, "a comment within this comment; take the inner ( out");
      comments_.push_back(source.substr(at + 1, end - at - 1));
      at = end;
      continue;
    }
    keep(letter >= 'a' && letter <= 'z' ? static_cast<char>(letter - 'a' + 'A') : letter, at + 1);
  }
}

std::size_t Line::column(std::size_t place) const noexcept {
  return place < columns_.size() ? columns_[place] : end_;
}

}  // namespace rmac::rs274
