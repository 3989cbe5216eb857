#include "gateway/json/json_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "gateway/json/printable.hpp"

namespace rmac::gateway {
namespace {

constexpr std::uintmax_t kMaxFileBytes = 1 << 20;
constexpr std::size_t kMaxDepth = 32;
constexpr std::size_t kMaxStringBytes =
    4096;  // the patterns of schemas run on std::regex, whose stack grows with the text

/// Walks the text before it is parsed: finds what the parser would let pass, and where a syntax error is.
class StrictReader final : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit StrictReader(const std::string& text) : text_(text) {}
  [[nodiscard]] const std::string& problem() const noexcept { return problem_; }

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t) override { return value(); }
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool binary(binary_t&) override { return value(); }

  bool string(string_t& text) override {
    if (text.size() > kMaxStringBytes) {
      return fail(
          fmt::format("{} is a text of {} bytes; at most {} are allowed", pointer(), text.size(), kMaxStringBytes));
    }
    return value();
  }

  bool key(string_t& name) override {
    Level& level = levels_.back();
    level.name.clear();
    if (!level.keys.insert(name).second) {
      return fail(fmt::format("the key \"{}\" stands twice in {}; keep one", name, pointer()));
    }
    level.name = name;
    return true;
  }

  bool start_object(std::size_t) override { return enter(); }
  bool start_array(std::size_t) override { return enter(); }
  bool end_object() override { return leave(); }
  bool end_array() override { return leave(); }

  bool parse_error(std::size_t position, const std::string&, const nlohmann::json::exception& error) override {
    // The parser stands behind the last character of the token that it could not take.
    const std::size_t end = std::min(position, text_.size());
    const auto last = text_.begin() + static_cast<std::ptrdiff_t>(end == 0 ? 0 : end - 1);
    const auto line = 1 + std::count(text_.begin(), last, '\n');
    const auto line_start = std::find(std::make_reverse_iterator(last), text_.rend(), '\n').base();
    std::string reason = error.what();
    for (const char* prefix_end : {"] ", "column "}) {
      if (const auto at = reason.find(prefix_end); at != std::string::npos) reason.erase(0, at + 2);
    }
    if (const auto at = reason.find(": "); at != std::string::npos) reason.erase(0, at + 2);
    return fail(fmt::format("line {}, column {} is not JSON: {}", line, 1 + (last - line_start), reason));
  }

 private:
  struct Level {
    std::set<std::string> keys;
    std::string name;
  };

  bool value() { return true; }
  bool enter() {
    if (levels_.size() >= kMaxDepth) return fail(fmt::format("{} nests deeper than {} levels", pointer(), kMaxDepth));
    levels_.emplace_back();
    return true;
  }
  bool leave() {
    levels_.pop_back();
    return true;
  }
  bool fail(const std::string& message) {
    problem_ = printable(message);
    return false;
  }
  [[nodiscard]] std::string pointer() const {
    std::string path;
    for (const Level& level : levels_) {
      if (!level.name.empty()) path += "/" + level.name;
    }
    return path.empty() ? "the document" : path;
  }

  const std::string& text_;
  std::vector<Level> levels_;
  std::string problem_;
};

Expected<std::string> read_text(const std::filesystem::path& file) {
  std::error_code code;
  // A pipe or a device would block the gateway; only a file has an end.
  if (!std::filesystem::is_regular_file(file, code)) {
    const bool exists = std::filesystem::exists(file, code);
    return failure(MinorCode::InvalidParameter, fmt::format("{}: {}", file.string(),
                                                            exists ? "this is a folder or a device, not a file"
                                                            : code ? "cannot be read: " + code.message()
                                                                   : "there is no such file"));
  }
  const std::uintmax_t size = std::filesystem::file_size(file, code);
  if (!code && size > kMaxFileBytes) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: the file has {} bytes; at most {} are read", file.string(), size, kMaxFileBytes));
  }
  std::string text(code ? 0 : size, '\0');
  std::ifstream stream(file, std::ios::binary);
  if (code || !stream.read(text.data(), static_cast<std::streamsize>(text.size()))) {
    return failure(MinorCode::Other, fmt::format("{}: the file cannot be read; check its permissions", file.string()));
  }
  return text;
}

}  // namespace

Expected<nlohmann::json> read_json_document(const std::filesystem::path& file, const JsonSchema& schema) {
  Expected<std::string> text = read_text(file);
  if (!text) return tl::make_unexpected(text.error());

  StrictReader reader(*text);
  if (!nlohmann::json::sax_parse(*text, &reader)) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", file.string(), reader.problem()));
  }
  nlohmann::json document = nlohmann::json::parse(*text, nullptr, false);
  if (const std::string problems = schema.check(document); !problems.empty()) {
    return failure(MinorCode::InvalidParameterValue, fmt::format("{}: {}", file.string(), problems));
  }
  return document;
}

}  // namespace rmac::gateway
