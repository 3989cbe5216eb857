#include "gateway/configuration/configuration.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/un.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "gateway/json/json_document.hpp"
#include "gateway/json/schemas.hpp"

namespace rmac::gateway {
namespace {

using Json = nlohmann::json;

bool is_loopback(const std::string& address) {
  in_addr v4{};
  if (inet_pton(AF_INET, address.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24U) == 127U;
  in6_addr v6{};
  return inet_pton(AF_INET6, address.c_str(), &v6) == 1 && IN6_IS_ADDR_LOOPBACK(&v6);
}

Json group(const Json& document, const char* key) {
  return document.value(key, Json::object());
}

/// The paths of the configuration: from the command line, else from the file, else by default.
class Paths {
 public:
  Paths(std::filesystem::path file_folder, const Json& document) : base_(std::move(file_folder)), document_(document) {}

  std::filesystem::path pick(const std::optional<std::filesystem::path>& overriding, const Json& group, const char* key,
                             const std::filesystem::path& otherwise) const {
    if (overriding) return overriding->empty() ? *overriding : absolute(*overriding);
    if (!group.contains(key)) return otherwise;
    const auto text = group[key].get<std::string>();
    return text.empty() ? std::filesystem::path() : from_file(text);
  }

  void fill(Configuration& configuration, const ConfigurationOverrides& overrides) const {
    const DefaultFolders folders = default_folders();
    configuration.state_folder = pick(overrides.state_folder, document_, "state_folder", folders.state_folder);
    // Who chooses a state folder runs a daemon of their own beside the installed one: its socket belongs there.
    const bool own_state = overrides.state_folder || document_.contains("state_folder");
    const std::filesystem::path& runtime = own_state ? configuration.state_folder : folders.runtime_folder;
    configuration.unix_socket =
        pick(overrides.unix_socket, group(document_, "listen"), "unix_socket", runtime / "rmacd.sock");
    configuration.device_tree = pick(overrides.device_tree, document_, "device_tree", folders.device_tree);
    configuration.drives_folder = pick({}, document_, "drives_folder", folders.drives);
    configuration.flight_recorder.folder =
        pick({}, group(document_, "flight_recorder"), "folder", configuration.state_folder / "flight-records");
    if (document_.contains("module_folders")) {
      for (const Json& folder : document_["module_folders"]) {
        configuration.module_folders.push_back(from_file(folder.get<std::string>()));
      }
    } else {
      configuration.module_folders.push_back(configuration.device_tree / "modules");
    }
    const std::string database = overrides.database ? *overrides.database : document_.value("database", std::string());
    if (database.empty()) {
      configuration.database = (configuration.state_folder / "device-drivers.sqlite").string();
    } else if (database.find("://") != std::string::npos) {
      configuration.database = database;
    } else {
      configuration.database = (overrides.database ? absolute(database) : from_file(database)).string();
    }
  }

 private:
  [[nodiscard]] std::filesystem::path from_file(const std::filesystem::path& path) const {
    return (base_ / path).lexically_normal();
  }
  static std::filesystem::path absolute(const std::filesystem::path& path) {
    return std::filesystem::absolute(path).lexically_normal();
  }

  std::filesystem::path base_;
  const Json& document_;
};

RealTimeSettings real_time_settings(const Json& settings) {
  RealTimeSettings real_time;
  if (const int cpu = settings.value("cpu", -1); cpu >= 0) real_time.cpu = cpu;
  real_time.priority = settings.value("priority", real_time.priority);
  real_time.sync_from = settings.value("sync_from", std::string());
  real_time.lock_memory = settings.value("lock_memory", real_time.lock_memory);
  constexpr int kMaxCyclesLost = 5;
  real_time.max_cycles_lost = settings.value("max_cycles_lost", kMaxCyclesLost);
  real_time.degraded_allowed = settings.value("degraded_allowed", real_time.degraded_allowed);
  return real_time;
}

/// The schema holds what is not read here to what it does anyway.
void read_stop_categories(const Json& chosen, Configuration& configuration) {
  const auto read = [&chosen](const char* key, StopCategory& category) {
    category = static_cast<StopCategory>(chosen.value(key, static_cast<int>(category)));
  };
  read("LeaseLost", configuration.lease_lost);
  StopCategories& stops = configuration.stop_categories;
  read("SensorLost", stops.sensor_lost);
  read("ForceLimit", stops.force_limit);
  read("ContactLost", stops.contact_lost);
  read("SpindleOverload", stops.spindle_overload);
  read("CycleDeadline", stops.cycles_lost);
  read("DriveHeartbeatLost", stops.drive_silent);
  if (!chosen.contains("CycleDeadline")) configuration.real_time.max_cycles_lost = 0;
}

Configuration from_document(const Json& document, const std::filesystem::path& file_folder,
                            const ConfigurationOverrides& overrides) {
  Configuration configuration;
  const Json listen = group(document, "listen");
  configuration.tcp = listen.value("tcp", configuration.tcp) || overrides.port.has_value();
  configuration.address = listen.value("address", configuration.address);
  configuration.port = overrides.port.value_or(listen.value("port", configuration.port));
  Paths(file_folder, document).fill(configuration, overrides);
  constexpr double kNanosecondsPerSecond = 1e9;
  configuration.period =
      std::chrono::nanoseconds(std::llround(document.value("period_s", 0.001) * kNanosecondsPerSecond));
  const bool fast = document.value("pace", std::string("real-time")) == "as-fast-as-computed";
  configuration.pace = overrides.pace.value_or(fast ? Pace::AsFastAsComputed : Pace::RealTime);
  configuration.real_time = real_time_settings(group(document, "real_time"));
  configuration.queue_capacity = document.value("queue_capacity", configuration.queue_capacity);
  read_stop_categories(group(document, "stop_categories"), configuration);
  constexpr double kMillisecondsPerSecond = 1e3;
  configuration.operator_alone_resumes = document.value("operator_alone_resumes", true);
  configuration.jog_while_waiting = document.value("jog_while_waiting", false);
  configuration.lease_timeout =
      std::chrono::milliseconds(std::llround(document.value("lease_timeout_s", 0.0) * kMillisecondsPerSecond));
  const Json recorder = group(document, "flight_recorder");
  configuration.flight_recorder.seconds = recorder.value("seconds", configuration.flight_recorder.seconds);
  configuration.flight_recorder.files_kept = recorder.value("files", configuration.flight_recorder.files_kept);
  if (document.contains("autoload")) {
    configuration.autoload = Autoload{.mechanism = document["autoload"]["mechanism"].get<std::string>(),
                                      .virtual_mode = document["autoload"].value("virtual", false)};
  }
  return configuration;
}

Expected<> check(const Configuration& configuration, const std::string& file) {
  if (!is_loopback(configuration.address)) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("{}: /listen/address is \"{}\"; allowed is a loopback address in figures, 127.0.0.1 or ::1. "
                    "Clients are not authenticated yet, so whoever reached another address could move the "
                    "machine; let them come through an SSH tunnel",
                    file, configuration.address));
  }
  if (!configuration.tcp && configuration.unix_socket.empty()) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: /listen/tcp is false and /listen/unix_socket is empty, so nobody could connect; "
                               "give one of them",
                               file));
  }
  constexpr std::size_t kLongestSocketPath = sizeof(sockaddr_un::sun_path) - 1;
  if (configuration.unix_socket.native().size() > kLongestSocketPath) {
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: /listen/unix_socket is {} ({} bytes); the system takes at most {} bytes. Choose a "
                               "shorter path, or \"\" for none",
                               file, configuration.unix_socket.string(), configuration.unix_socket.native().size(),
                               kLongestSocketPath));
  }
  return {};
}

}  // namespace

Expected<Configuration> read_configuration(const std::filesystem::path& rmacd_json,
                                           const ConfigurationOverrides& overrides) {
  try {
    static const JsonSchema kSchema(rmacd_schema_text());
    const Expected<Json> document = read_json_document(rmacd_json, kSchema);
    if (!document) return tl::make_unexpected(document.error());
    const std::filesystem::path folder = std::filesystem::absolute(rmacd_json).parent_path();
    Configuration configuration = from_document(*document, folder, overrides);
    if (const Expected<> checked = check(configuration, rmacd_json.string()); !checked) {
      return tl::make_unexpected(checked.error());
    }
    return configuration;
  } catch (const std::exception& error) {
    return failure(MinorCode::Other, fmt::format("{}: {}", rmacd_json.string(), error.what()));
  }
}

}  // namespace rmac::gateway
