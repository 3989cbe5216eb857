#include "gateway/rmac/wire/fault_watch.hpp"

#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

using Kind = gateway::Event::Kind;

FaultWatch::FaultWatch(Connection& connection, HearsOf what) : connection_(connection) {
  connection_.on_notification([this, what](const std::string& topic, const nlohmann::json& note) {
    if (topic != kEventsTopic) return;
    const EventNote event = read_event(note);
    if (event.is(Kind::Fault) || (what == HearsOf::FaultsAndStops && event.is(Kind::Stopped))) failure_ = event.message;
  });
}

Result<> FaultWatch::begin() {
  return subscribe(connection_, kEventsTopic);
}

}  // namespace rmac::cli
