#include "clients/legacy/program/input_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string_view>
#include <system_error>
#include <utility>

namespace rmac::legacy {

namespace {

namespace fs = std::filesystem;

/// What it is instead of a program's text, or nothing.
std::optional<std::string> is_no_program(const std::string& text) {
  if (text.find_first_not_of(" \t\r\n") == std::string::npos) return "is empty";
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    return "is text in UTF-16; save it as plain text, which is ASCII or UTF-8";
  }
  if (text.find('\0') != std::string::npos) return "is no text";
  return std::nullopt;
}

}  // namespace

tl::expected<std::string, std::string> read_file(const std::string& name) {
  std::ifstream opened;
  if (name != "-") {
    std::error_code none;
    if (fs::is_directory(name, none)) return tl::unexpected<std::string>("is a folder");
    opened.open(name, std::ios::binary);
    if (!opened) {
      return tl::unexpected(fmt::format("cannot be read: {}", std::generic_category().message(errno)));
    }
  }
  std::istream& input = name == "-" ? std::cin : opened;
  std::string text{std::istreambuf_iterator<char>(input), {}};
  if (input.bad()) return tl::unexpected<std::string>("cannot be read");
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  if (auto other = is_no_program(text)) return tl::unexpected(std::move(*other));
  return text;
}

tl::expected<std::optional<NamedText>, std::string> find_file(const std::vector<std::string>& folders,
                                                              const std::string& name, const std::string& program) {
  for (const std::string& folder : folders) {
    const std::string file = (fs::path(folder) / name).string();
    std::error_code none;
    if (!fs::is_regular_file(file, none) || fs::equivalent(file, program, none)) continue;
    auto text = read_file(file);
    if (!text) return tl::unexpected(fmt::format("{}: {}", file, text.error()));
    return NamedText{file, std::move(*text)};
  }
  return std::nullopt;
}

}  // namespace rmac::legacy
