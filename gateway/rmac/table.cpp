#include "gateway/rmac/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace rmac::cli {

namespace {

bool is_number(const std::string& cell) {
  return !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell[0])) != 0 || cell[0] == '-' || cell[0] == '.');
}

}  // namespace

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width(header.size());
  std::vector<bool> right(header.size(), !rows.empty());
  for (std::size_t column = 0; column < header.size(); ++column) {
    width[column] = header[column].size();
    for (const auto& row : rows) {
      width[column] = std::max(width[column], row[column].size());
      right[column] = right[column] && (row[column].empty() || is_number(row[column]));
    }
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t column = 0; column < header.size(); ++column) {
      line += column == 0 ? "" : "  ";
      line += right[column] ? fmt::format("{:>{}}", row[column], width[column])
                            : fmt::format("{:<{}}", row[column], width[column]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + '\n';
  };
  if (std::any_of(header.begin(), header.end(), [](const auto& title) { return !title.empty(); })) {
    add(header);
  }
  std::for_each(rows.begin(), rows.end(), add);
  return text;
}

std::string number(double value, int digits) {
  auto text = fmt::format("{:.{}f}", value, digits);
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') {
      text.pop_back();
    }
  }
  return text == "-0" ? "0" : text;
}

}  // namespace rmac::cli
