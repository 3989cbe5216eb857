#include "eds/ini.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::fieldbus::eds {
namespace {

constexpr std::string_view kBlank = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

tl::unexpected<Error> mistake(const std::string& file, std::size_t line, const std::string& what) {
  return failure(MinorCode::InvalidParameterValue, fmt::format("{}:{}: {}", file, line, what));
}

const IniValue* IniSection::find(const std::string& key) const {
  const auto found = values.find(key);
  return found == values.end() || found->second.text.empty() ? nullptr : &found->second;
}

Expected<IniDocument> parse_ini(std::string_view text, const std::string& file) {
  IniDocument document;
  IniSection* section = nullptr;
  std::size_t number = 0;
  if (constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF"; text.starts_with(kByteOrderMark)) {
    text.remove_prefix(kByteOrderMark.size());  // editors of one system put it there
  }
  while (!text.empty()) {
    ++number;
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == ';') continue;
    if (line.front() == '[') {
      if (line.back() != ']' || line.size() < 3) return mistake(file, number, "a section is written [Name]");
      const std::string name(trimmed(line.substr(1, line.size() - 2)));
      const auto [at, is_new] = document.try_emplace(lower_case(name), IniSection{name, number, {}});
      if (!is_new) {
        return mistake(file, number,
                       fmt::format("section [{}] stands here for the second time; the first is in line {}", name,
                                   at->second.line));
      }
      section = &at->second;
      continue;
    }
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos || equals == 0) {
      return mistake(file, number, "this is neither a section, nor name=value, nor a comment behind a semicolon");
    }
    if (section == nullptr) return mistake(file, number, "a value stands before the first section");
    const std::string_view key = trimmed(line.substr(0, equals));
    const auto [at, is_new] =
        section->values.try_emplace(lower_case(key), IniValue{std::string(trimmed(line.substr(equals + 1))), number});
    if (!is_new) {
      return mistake(file, number,
                     fmt::format("{} stands in [{}] for the second time; the first is in line {}", key, section->name,
                                 at->second.line));
    }
  }
  return document;
}

}  // namespace rmac::fieldbus::eds
