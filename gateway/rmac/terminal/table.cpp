#include "gateway/rmac/terminal/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "gateway/json/printable.hpp"

namespace rmac::cli {

namespace {

bool is_number(const std::string& cell) {
  return !cell.empty() && (std::isdigit(static_cast<unsigned char>(cell[0])) != 0 || cell[0] == '-' || cell[0] == '.');
}

/// Characters, each of which a terminal gives one column: bytes, but those that go on with a character.
std::size_t width(const std::string& cell) {
  return static_cast<std::size_t>(
      std::count_if(cell.begin(), cell.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xc0) != 0x80; }));
}

}  // namespace

std::string table(const std::vector<std::string>& header, std::vector<std::vector<std::string>> rows) {
  std::vector<std::size_t> widest(header.size());
  std::vector<bool> right(header.size(), !rows.empty());
  for (std::size_t column = 0; column < header.size(); ++column) {
    widest[column] = width(header[column]);
    for (auto& row : rows) {
      row[column] = gateway::printable(row[column]);
      widest[column] = std::max(widest[column], width(row[column]));
      right[column] = right[column] && (row[column].empty() || is_number(row[column]));
    }
  }
  std::string text;
  const auto add = [&](const std::vector<std::string>& row) {
    std::string line;
    for (std::size_t column = 0; column < header.size(); ++column) {
      line += column == 0 ? "" : "  ";
      const std::string blanks(widest[column] - width(row[column]), ' ');
      line += right[column] ? blanks + row[column] : row[column] + blanks;
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
