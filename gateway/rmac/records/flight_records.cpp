#include "gateway/rmac/records/flight_records.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "gateway/files/whole_file.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {
/// A record of ten seconds is on a disk in well under one; a disk that hangs must not hang the terminal.
constexpr std::chrono::seconds kWriteBound{60};

using Kind = gateway::Event::Kind;
}  // namespace

Result<std::string> fetch_flight_record(Connection& connection, const std::string& name) {
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
  if (auto written = gateway::write_whole(file, text); !written) return fail(written.error().message);
  return {};
}

Result<EventNote> record_flight(Connection& connection) {
  std::vector<EventNote> heard;
  connection.on_notification([&](const std::string& topic, const nlohmann::json& params) {
    if (topic != kEventsTopic) return;
    auto event = read_event(params);
    if (event.is(Kind::FlightRecord) || event.is(Kind::FlightRecordFailed)) heard.push_back(std::move(event));
  });
  auto done = [&]() -> Result<EventNote> {
    if (auto events = subscribe(connection, kEventsTopic); !events) return tl::unexpected(events.error());
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
    if (!told()->is(Kind::FlightRecord)) return fail(told()->message);
    return *told();
  }();
  connection.on_notification({});
  return done;
}

}  // namespace rmac::cli
