#include <fmt/format.h>

#include <cstdio>

#include "gateway/rmac/commands/watch/interruption.hpp"
#include "gateway/rmac/commands/watch/registrations.hpp"
#include "gateway/rmac/terminal/table.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

Result<> show_events(Connection& connection, bool json) {
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != kEventsTopic) {
      return;
    }
    const auto event = read_event(params);
    if (json) {
      fmt::print("{}\n", params.dump());
    } else {
      fmt::print(
          "{:>12}  {:>10}  {:<18}{}{}{}\n", number(event.t_s), event.cycle, event.kind,
          event.move_id > 0 ? fmt::format("move {}  ", event.move_id) : "", event.message,
          event.is(gateway::Event::Kind::Fault) && !event.record.empty() ? "; flight record " + event.record : "");
    }
    std::fflush(stdout);
  });
  if (auto heard = subscribe(connection, kEventsTopic); !heard) return heard;
  auto done = wait_until_interrupted(connection);
  connection.on_notification({});
  return done;
}

}  // namespace

void add_events(Command& rmac) {
  Command events = rmac.add("events", "follow what happens until Ctrl-C");
  events.does(with_appliance(show_events));
}

}  // namespace rmac::cli
