// The flight records of the appliance: list, make, fetch, draw.
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "gateway/configuration/configuration.hpp"
#include "gateway/rmac/commands.hpp"
#include "gateway/rmac/notes.hpp"
#include "gateway/rmac/table.hpp"

namespace rmac::cli {

namespace {

/// A record of ten seconds is on a disk in well under one; a disk that hangs must not hang the terminal.
constexpr std::chrono::seconds kWriteBound{60};
constexpr const char* kPython = "/usr/bin/python3";
constexpr const char* kPlotProgram = "plot_flight_record.py";

Result<nlohmann::json> records_of(Connection& connection) {
  auto answer = connection.call("FlightRecorder.List");
  if (!answer) return tl::unexpected(answer.error());
  return answer->value("records", nlohmann::json::array());
}

Result<std::string> name_or_newest(Connection& connection, const std::string& name) {
  if (!name.empty()) return name;
  auto records = records_of(connection);
  if (!records) return tl::unexpected(records.error());
  if (records->empty()) {
    return fail("there is no flight record yet; a fault makes one, and so does `rmac trace record`");
  }
  return records->back().value("name", "");
}

Result<std::string> fetch(Connection& connection, const std::string& name) {
  std::string text;
  nlohmann::json offset = 0;
  while (!offset.is_null()) {
    const auto part = connection.call("FlightRecorder.Read", {{"Name", name}, {"Offset", offset}});
    if (!part) return tl::unexpected(part.error());
    const std::string piece = part->value("text", "");
    offset = part->value("next_offset", nlohmann::json());
    if (piece.empty() && !offset.is_null()) return fail(fmt::format("flight record {} came incomplete", name));
    text += piece;
  }
  return text;
}

Result<> write_file(const std::string& file, std::string_view text) {
  if (file == "-") {
    std::fwrite(text.data(), 1, text.size(), stdout);
    return std::fflush(stdout) == 0 ? Result<>() : fail("standard output cannot be written");
  }
  std::ofstream output(file, std::ios::trunc | std::ios::binary);
  output << text;
  output.close();
  if (output) return {};
  return fail(fmt::format("{}: cannot be written: {}", file, std::generic_category().message(errno)));
}

/// A file of this process that goes when it goes.
class TemporaryFile {
 public:
  TemporaryFile() {
    const int descriptor = ::mkstemp(path_.data());
    if (descriptor >= 0) ::close(descriptor);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() { ::unlink(path_.c_str()); }
  [[nodiscard]] const std::string& path() const noexcept { return path_; }

 private:
  std::string path_ = (std::filesystem::temp_directory_path() / "rmac-trace-XXXXXX").string();
};

Result<> run_plot(const std::string& record, const std::string& picture) {
  std::string program = (gateway::default_folders().helpers / kPlotProgram).string();
  std::string python = kPython;
  std::string no_cache = "-B";
  std::string from = record;
  std::string to = picture;
  const std::array<char*, 6> words{python.data(), no_cache.data(), program.data(), from.data(), to.data(), nullptr};
  pid_t child = 0;
  if (const int problem = ::posix_spawn(&child, kPython, nullptr, nullptr, words.data(), environ); problem != 0) {
    return fail(fmt::format("{} cannot be run: {}; install python3 and python3-matplotlib", kPython,
                            std::generic_category().message(problem)));
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  return fail(fmt::format("{} could not draw {}; its message is above. It needs python3-matplotlib", program, picture));
}

}  // namespace

Result<> list_records(Connection& connection, bool json) {
  auto records = records_of(connection);
  if (!records) return tl::unexpected(records.error());
  if (json) {
    fmt::print("{}\n", records->dump());
    return {};
  }
  std::vector<std::vector<std::string>> rows;
  for (const auto& record : *records) {
    rows.push_back({record.value("name", ""), record.value("mechanism", ""),
                    std::to_string(record.value("cycle", std::int64_t{0})), record.value("message", "")});
  }
  if (rows.empty()) {
    fmt::print("no flight records\n");
    return {};
  }
  fmt::print("{}", table({"name", "machine", "cycle", "what happened"}, rows));
  return {};
}

Result<> make_record(Connection& connection, bool json) {
  std::vector<EventNote> heard;
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != "events") return;
    if (auto event = read_event(params); event.kind.starts_with("FlightRecord")) heard.push_back(std::move(event));
  });
  auto done = [&]() -> Result<> {
    if (auto topics = connection.call("subscribe", {{"topics", {"events"}}}); !topics) {
      return tl::unexpected(topics.error());
    }
    const auto asked = connection.call("FlightRecorder.Record");
    if (!asked) return tl::unexpected(asked.error());
    const auto name = asked->get<std::string>();
    const auto told = [&]() -> const EventNote* {
      for (const EventNote& event : heard) {
        if (event.record == name) return &event;
      }
      return nullptr;
    };
    const auto waited = connection.wait([&] { return told() != nullptr; }, kWriteBound);
    if (!waited) return tl::unexpected(waited.error());
    if (!*waited) return fail(fmt::format("flight record {} is not written yet; look again later", name));
    if (told()->kind != "FlightRecord") return fail(told()->message);
    fmt::print("{}\n", json ? nlohmann::json{{"name", name}}.dump() : told()->message);
    return {};
  }();
  connection.on_notification({});
  return done;
}

Result<> export_record(Connection& connection, const std::string& name, const std::string& file) {
  const auto chosen = name_or_newest(connection, name);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto text = fetch(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  // The first line says what the record is of; the rest is CSV as other records are.
  const std::string target = file.empty() ? *chosen + ".csv" : file;
  const auto written =
      write_file(target, std::string_view(*text).substr(std::min(text->find('\n'), text->size() - 1) + 1));
  if (written && target != "-") fmt::print("{}\n", target);
  return written;
}

Result<> plot_record(Connection& connection, const std::string& name, const std::string& file) {
  const auto chosen = name_or_newest(connection, name);
  if (!chosen) return tl::unexpected(chosen.error());
  const auto text = fetch(connection, *chosen);
  if (!text) return tl::unexpected(text.error());
  const TemporaryFile record;
  if (auto written = write_file(record.path(), *text); !written) return written;
  const std::string target = file.empty() ? *chosen + ".png" : file;
  auto drawn = run_plot(record.path(), target);
  if (drawn) fmt::print("{}\n", target);
  return drawn;
}

}  // namespace rmac::cli
