#include "gateway/rmac/commands/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

#include "gateway/json/finite_numbers.hpp"
#include "gateway/json/printable.hpp"

namespace rmac::cli {

namespace {

int report(const Failure& failure) {
  // One line, whatever the message held: scripts read it so.
  const auto message = gateway::printable(failure.message.substr(0, failure.message.find_last_not_of('\n') + 1));
  fmt::print(stderr, "rmac: {}\n", message);
  return kExitFailed;
}

int report(const CLI::App& app, const CLI::ParseError& error) {
  // CLI11 tells of a word that is no command only that a command is missing.
  const auto left = app.remaining(true);
  if (error.get_name() != "RequiredError" || left.empty()) return app.exit(error) == 0 ? kExitDone : kExitUsage;
  fmt::print(stderr, "rmac: there is no {}; rmac --help lists what there is\n", gateway::printable(left.front()));
  return kExitUsage;
}

int parse_and_do(std::span<const Registration> commands, int count, const char* const* words) {
  CLI::App app{"rmac talks to the fieldbus gateway appliance, rmacd.", "rmac"};
  app.set_version_flag("--version", RMAC_VERSION);
  app.require_subcommand(1);
  app.fallthrough();
  Endpoint endpoint;
  bool json = false;
  Action chosen;
  Command rmac(&app, &chosen);
  rmac.option("--socket", &endpoint.socket, "UNIX socket of the appliance").reads_environment("RMAC_SOCKET");
  rmac.option("--host", &endpoint.host, "host of the appliance").reads_environment("RMAC_HOST").shows_default();
  rmac.option("--port", &endpoint.port, "its TCP port").reads_environment("RMAC_PORT").shows_default();
  rmac.flag("--json", &json, "print for programs");
  for (const Registration add : commands) add(rmac);
  gateway::take_finite_numbers_only(app);
  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    return report(app, error);
  }
  Call call(endpoint, json);
  const auto done = chosen(call);
  return done ? kExitDone : report(done.error());
}

}  // namespace

int carry_out(std::span<const Registration> commands, int count, const char* const* words) {
  try {
    return parse_and_do(commands, count, words);
  } catch (const std::exception& error) {
    return report(Failure{error.what()});
  }
}

}  // namespace rmac::cli
