#include "gateway/rmac/view/page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>

#include "gateway/configuration/configuration.hpp"
#include "gateway/files/whole_file.hpp"

namespace rmac::cli {
namespace {

namespace fs = std::filesystem;

/// Lines of page.html that begin with it give way to a file, or to the data.
constexpr std::string_view kInclude = "@include ", kData = "@data";

Result<std::string> text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  if (!file)
    return fail(fmt::format("{}: is missing; it comes with rmac, which is to be installed again", path.string()));
  return text;
}

/// Nothing in it ends the script that holds it, whatever bodies are called.
std::string text_of(const nlohmann::json& data) {
  const std::string plain = data.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
  std::string text;
  text.reserve(plain.size());
  for (const char c : plain) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

fs::path page_folder() {
  return gateway::default_folders().helpers / "view";
}

Result<std::size_t> write_page(const nlohmann::json& data, const std::string& file) {
  const fs::path folder = page_folder();
  const auto page = text_of(folder / "page.html");
  if (!page) return tl::unexpected(page.error());
  std::string text;
  for (std::size_t from = 0; from < page->size();) {
    const std::size_t end = std::min(page->find('\n', from), page->size());
    const std::string_view line = std::string_view(*page).substr(from, end - from);
    from = end + 1;
    if (line.starts_with(kInclude)) {
      const auto part = text_of(folder / line.substr(kInclude.size()));
      if (!part) return tl::unexpected(part.error());
      text += *part;
    } else {
      text += line == kData ? text_of(data) : std::string(line);
    }
    text += '\n';
  }
  if (auto written = gateway::write_whole(file, text); !written) return fail(written.error().message);
  return text.size();
}

}  // namespace rmac::cli
