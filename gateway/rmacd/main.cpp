// rmacd, the daemon of the appliance. Exit codes: 0 ended as asked, 1 refused or failed with one line on stderr, 2
// usage.
#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "gateway/api/methods/openrpc.hpp"
#include "gateway/buses/drive_library_file.hpp"
#include "gateway/rmacd/daemon.hpp"

namespace {

constexpr int kFailed = 1;
constexpr int kUsage = 2;

struct Wishes {
  std::string config;
  bool check = false;
  bool print_api = false;
  bool print_openrpc = false;
  std::optional<std::uint16_t> port;
  std::optional<std::string> unix_socket, state_dir, device_tree, pace;
};

int fail(const std::string& message) {
  fmt::print(stderr, "rmacd: {}\n", message);
  return kFailed;
}

rmac::gateway::ConfigurationOverrides overrides_of(const Wishes& wishes) {
  rmac::gateway::ConfigurationOverrides overrides;
  overrides.port = wishes.port;
  if (wishes.unix_socket) overrides.unix_socket = *wishes.unix_socket;
  if (wishes.state_dir) overrides.state_folder = *wishes.state_dir;
  if (wishes.device_tree) overrides.device_tree = *wishes.device_tree;
  if (wishes.pace) {
    overrides.pace =
        *wishes.pace == "real-time" ? rmac::gateway::Pace::RealTime : rmac::gateway::Pace::AsFastAsComputed;
  }
  return overrides;
}

int run(const Wishes& wishes) {
  if (wishes.print_api) {
    fmt::print("{}", rmac::gateway::api_page());
    return 0;
  }
  if (wishes.print_openrpc) {
    fmt::print("{}\n", rmac::gateway::openrpc_document().dump(2));
    return 0;
  }
  auto configuration = rmac::gateway::read_configuration(wishes.config, overrides_of(wishes));
  if (!configuration) return fail(configuration.error().message);
  if (wishes.check) {
    const auto drives = rmac::gateway::read_drive_library(configuration->drives_folder);
    if (auto sound = rmac::gateway::check(drives); !sound) return fail(sound.error().message);
    fmt::print("{} is valid\n", wishes.config);
    return 0;
  }
  spdlog::set_default_logger(spdlog::stderr_color_mt("rmacd"));
  spdlog::flush_on(spdlog::level::info);
  if (auto ended = rmac::gateway::run_daemon(*configuration); !ended) return fail(ended.error().message);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"The RMAC gateway daemon: a machine tool behind a socket."};
  app.set_version_flag("--version", RMAC_VERSION);
  Wishes wishes;
  auto* config = app.add_option("--config", wishes.config, "Configuration file, rmacd.json");
  app.add_flag("--check", wishes.check, "Check the configuration and end");
  app.add_flag("--print-api", wishes.print_api, "Print docs/api.md and end");
  app.add_flag("--print-openrpc", wishes.print_openrpc, "Print the API as an OpenRPC document and end");
  app.add_option("--port", wishes.port, "TCP port; 0: any free one");
  app.add_option("--unix-socket", wishes.unix_socket, "Path of the UNIX socket");
  app.add_option("--state-dir", wishes.state_dir, "Folder of what it keeps: database, tool tables, flight records");
  app.add_option("--device-tree", wishes.device_tree, "Folder that holds <type>/<configuration>/<Mechanism>");
  app.add_option("--pace", wishes.pace, "What paces the servo loop")
      ->check(CLI::IsMember({"real-time", "as-fast-as-computed"}));
  try {
    app.parse(argc, argv);
    if (config->count() == 0 && !wishes.print_api && !wishes.print_openrpc) {
      throw CLI::RequiredError("--config");
    }
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kUsage;
  }
  try {
    return run(wishes);
  } catch (const std::exception& error) {
    return fail(error.what());
  }
}
