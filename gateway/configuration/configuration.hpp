#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gateway/record/flight_recorder_options.hpp"
#include "rmac/motion/error.hpp"
#include "rmac/motion/servo/servo_fault.hpp"

namespace rmac::gateway {

/// What paces the servo loop: the clock of the machine, or nothing but the computation (for tests and simulated buses).
enum class Pace { RealTime, AsFastAsComputed };

struct RealTimeSettings {
  std::optional<int> cpu;  ///< processor of the servo thread; none: wherever the kernel puts it
  int priority = 80;       ///< SCHED_FIFO, 1 to 99
  bool lock_memory = true;
  std::string sync_from;         ///< CAN interface whose SYNC begins each cycle; empty: the timer does
  bool degraded_allowed = true;  ///< run, with a warning, when the system grants no real-time scheduling
  int max_cycles_lost = 0;       ///< missed deadlines within a second that stop the machine beyond it; 0: none does
};

/// A mechanism to load when the daemon starts.
struct Autoload {
  std::string mechanism;
  bool virtual_mode = false;
};

/// The daemon's configuration, `rmacd.json`, complete: every value that the file leaves out has its default. Paths are
/// absolute.
struct Configuration {
  bool tcp = true;                    ///< a TCP port beside the UNIX socket
  std::string address = "127.0.0.1";  ///< a loopback address
  std::uint16_t port = 7402;          ///< 0: the system picks a free one
  std::filesystem::path unix_socket;  ///< empty: none
  std::filesystem::path state_folder;
  std::filesystem::path device_tree;                  ///< holds <type>/<configuration>/<Mechanism>/device.json
  std::vector<std::filesystem::path> module_folders;  ///< where modules are looked for after the mechanism's own folder
  std::filesystem::path drives_folder;                ///< holds descriptions of CANopen drives
  std::string database;                               ///< path of the SQLite file, or a "postgresql://…" connection
  std::chrono::nanoseconds period{1'000'000};
  Pace pace = Pace::RealTime;
  RealTimeSettings real_time;
  int queue_capacity = 10'000;  ///< moves
  StopCategory lease_lost = StopCategory::StopKeepPower;
  StopCategories stop_categories;
  std::chrono::milliseconds lease_timeout{0};  ///< silence of its holder that ends the lease; 0: none
  bool operator_alone_resumes = true;          ///< what the operator holds; else the holder of authority, too
  bool jog_while_waiting = false;              ///< a jog ends a cycle that has nothing queued
  FlightRecorderOptions flight_recorder;
  std::optional<Autoload> autoload;
};

/// What the command line puts over the file; values that follow from one of these (the database's place from the state
/// folder, the module folders from the device tree) follow it.
struct ConfigurationOverrides {
  std::optional<std::uint16_t> port{};
  std::optional<std::filesystem::path> unix_socket{};
  std::optional<std::filesystem::path> state_folder{};
  std::optional<std::filesystem::path> device_tree{};
  std::optional<std::string> database{};
  std::optional<Pace> pace{};
};

/// Where things are when neither file nor command line says so.
struct DefaultFolders {
  std::filesystem::path device_tree;
  std::filesystem::path drives;     ///< the library of CANopen drives
  std::filesystem::path materials;  ///< the work materials that are known, a file
  std::filesystem::path state_folder;
  std::filesystem::path runtime_folder;  ///< holds the UNIX socket
  std::filesystem::path helpers;         ///< programs that ours start
  std::filesystem::path verifier;        ///< the one of them that checks modules
  std::filesystem::path searcher;        ///< the one of them that runs clients' SQL
};

/// A daemon in a build tree uses that tree; an installed one the folders of its installation, and under systemd the
/// state and runtime folders that its unit was given ($STATE_DIRECTORY, $RUNTIME_DIRECTORY).
[[nodiscard]] DefaultFolders default_folders();

/// Reads `rmacd.json`. Relative paths in the file are relative to the file's folder; those of the command line to the
/// current one. An error names file, key, value and allowed range.
[[nodiscard]] Expected<Configuration> read_configuration(const std::filesystem::path& rmacd_json,
                                                         const ConfigurationOverrides& overrides = {});

}  // namespace rmac::gateway
