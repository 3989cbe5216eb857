#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <regex>
#include <system_error>

#include "gateway/record/flight_record.hpp"

namespace rmac::gateway {
namespace {

constexpr const char* kExtension = ".flight";
/// One answer holds at most so much of a record's text.
constexpr std::size_t kPartBytes = 256U << 10U;
/// A head is shorter, with all 127 nodes of two buses and all that is kept of each; a file that is none is not read to
/// its end.
constexpr std::size_t kLongestHead = 1U << 20U;
/// Objects and arrays within each other that a head has room for; who writes out a list of more needs more stack.
constexpr int kDeepestHead = 16;

const char* word(FlightCause cause) {
  return cause == FlightCause::Fault ? "fault" : "demand";
}

/// Names come from clients: nothing but our own pattern becomes part of a path.
bool is_name(const std::string& name) {
  static const std::regex kPattern(R"(\d{8}T\d{6}\.\d{3}Z-(fault|demand)-\d+)");
  return name.size() < 100 && std::regex_match(name, kPattern);
}

/// Null where it is none.
nlohmann::json head_of(const std::string& line) {
  using nlohmann::json;
  bool too_deep = false;
  const auto look = [&](int depth, json::parse_event_t /*event*/, json& /*value*/) {
    too_deep = too_deep || depth > kDeepestHead;
    return !too_deep;
  };
  json head = json::parse(line, look, false);
  return head.is_object() && !too_deep ? head : json();
}

}  // namespace

std::string FlightFolder::name_for(FlightCause cause, std::int64_t cycle, std::chrono::system_clock::time_point now) {
  const auto ms = std::chrono::floor<std::chrono::milliseconds>(now);
  const auto second = std::chrono::floor<std::chrono::seconds>(ms);
  return fmt::format("{:%Y%m%dT%H%M%S}.{:03}Z-{}-{}", fmt::gmtime(std::chrono::system_clock::to_time_t(second)),
                     (ms - second).count(), word(cause), cycle);
}

std::filesystem::path FlightFolder::file_of(const std::string& name) const {
  return folder_ / (name + kExtension);
}

std::vector<std::string> FlightFolder::names() const {
  std::vector<std::string> found;
  std::error_code problem;
  for (std::filesystem::directory_iterator entry(folder_, problem), end; !problem && entry != end;
       entry.increment(problem)) {
    if (entry->path().extension() != kExtension) continue;
    if (std::string name = entry->path().stem().string(); is_name(name)) found.push_back(std::move(name));
  }
  std::sort(found.begin(), found.end());
  return found;
}

nlohmann::json FlightFolder::list() const {
  nlohmann::json records = nlohmann::json::array();
  std::string line(kLongestHead, '\0');
  for (const std::string& name : names()) {
    std::error_code problem;
    const auto bytes = std::filesystem::file_size(file_of(name), problem);
    std::ifstream file(file_of(name));
    file.getline(line.data(), static_cast<std::streamsize>(line.size()));
    auto head = problem || file.fail() ? nlohmann::json() : head_of(line.data());
    if (head.is_null()) continue;
    head.erase("buses");
    head["name"] = name;
    head["bytes"] = bytes;
    records.push_back(std::move(head));
  }
  return records;
}

Expected<nlohmann::json> FlightFolder::read(const std::string& name, std::int64_t offset) const {
  std::ifstream file;
  if (is_name(name)) file.open(file_of(name));
  if (!file.is_open()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("there is no flight record \"{}\"; FlightRecorder.List names those that there are",
                               name.substr(0, 100)));
  }
  file.seekg(0, std::ios::end);
  const auto bytes = static_cast<std::int64_t>(file.tellg());
  const std::int64_t from = std::clamp<std::int64_t>(offset, 0, bytes);
  std::string text(std::min<std::size_t>(kPartBytes, static_cast<std::size_t>(bytes - from)), '\0');
  file.seekg(from);
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file) return failure(MinorCode::Other, fmt::format("flight record {} cannot be read", name));
  const std::int64_t next = from + static_cast<std::int64_t>(text.size());
  return nlohmann::json{{"text", std::move(text)},
                        {"next_offset", next < bytes ? nlohmann::json(next) : nlohmann::json()},
                        {"bytes", bytes}};
}

void FlightFolder::prune(FlightCause cause, std::size_t kept) const noexcept {
  try {
    auto of_cause = names();
    const std::string mark = fmt::format("-{}-", word(cause));
    std::erase_if(of_cause, [&](const std::string& name) { return name.find(mark) == std::string::npos; });
    std::error_code problem;
    for (std::size_t i = 0; i + kept < of_cause.size(); ++i) std::filesystem::remove(file_of(of_cause[i]), problem);
  } catch (...) {
    // No memory, at worst: the next record prunes again.
  }
}

void FlightFolder::remove_unfinished() const noexcept {
  try {
    std::error_code problem;
    std::vector<std::filesystem::path> unfinished;
    for (std::filesystem::directory_iterator entry(folder_, problem), end; !problem && entry != end;
         entry.increment(problem)) {
      // As WholeFile names them where it must: the record's name, perhaps the process's number, ".part".
      const auto& path = entry->path();
      const auto record = path.stem().extension() == kExtension ? path.stem() : path.stem().stem();
      if (path.extension() == ".part" && record.extension() == kExtension && is_name(record.stem().string()))
        unfinished.push_back(path);
    }
    for (const auto& path : unfinished) std::filesystem::remove(path, problem);
  } catch (...) {
    // As above.
  }
}

}  // namespace rmac::gateway
