#include "gateway/server/line_reader.hpp"

#include <utility>

namespace rmac::gateway {

std::optional<LineReader::Line> LineReader::next() {
  while (!too_long_ && !chunk_.empty()) {
    const std::size_t end = chunk_.find('\n');
    const std::string_view part = chunk_.substr(0, end);
    too_long_ = begun_.size() + part.size() > limit_bytes_;
    if (too_long_) break;
    const bool whole = end != std::string_view::npos;
    chunk_.remove_prefix(whole ? end + 1 : chunk_.size());
    if (!whole || !begun_.empty()) begun_.append(part);
    if (!whole) break;
    line_ = std::exchange(begun_, {});
    if (auto line = line_of(line_.empty() ? part : line_)) return line;
  }
  return std::nullopt;
}

std::optional<LineReader::Line> LineReader::last() {
  line_ = std::exchange(begun_, {});
  return line_of(line_);
}

void LineReader::clear() noexcept {
  chunk_ = {};
  begun_ = {};
}

std::optional<LineReader::Line> LineReader::line_of(std::string_view text) {
  const std::uint64_t position = position_;
  position_ += text.size() + 1;
  if (text.ends_with('\r')) text.remove_suffix(1);
  if (text.find_first_not_of(" \t") == std::string_view::npos) return std::nullopt;
  return Line{text, position};
}

}  // namespace rmac::gateway
