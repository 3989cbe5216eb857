#include "gateway/rmac/program/prompt.hpp"

#include <fmt/format.h>

#include <charconv>

#include "gateway/rmac/wire/authority.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

const nlohmann::json kNothing = nlohmann::json::object();

}  // namespace

void Prompt::obey(const std::string& line) {
  note_.clear();
  if (line.empty() && state_ && !state_->tool_prompt.empty()) {
    ask(kConfirmToolChange, {{"ToolNumber", state_->tool_wanted}});
  } else if (parked_) {
    if (line.empty()) take_up();
  } else if (line == "p") {
    park();
  } else if (line.empty()) {
    // Whoever holds a program from another terminal cannot resume it there: this client has the lease.
    connection_.send(kResumeFeed, kNothing, [](const Connection::Answer&) {});
  } else {
    retrace(line);
  }
}

std::string Prompt::text() const {
  if (!state_) return note_;
  if (!state_->tool_prompt.empty()) return state_->tool_prompt + ", or Enter";
  if (parked_) return note_.empty() ? "parked: Enter takes it up again" : note_;
  if (!state_->is(gateway::CycleState::Holding)) return fmt::format("{:.0f} mm/min", state_->feed_actual);
  return note_.empty() ? "held: Enter goes on, a distance in mm runs back, p parks" : note_;
}

void Prompt::retrace(const std::string& distance_mm) {
  double mm = 0;
  const char* const end_of_line = distance_mm.data() + distance_mm.size();
  const auto [end, error] = std::from_chars(distance_mm.data(), end_of_line, mm);
  if (error != std::errc() || end != end_of_line) {
    note_ = fmt::format("\"{}\" is no distance in mm", distance_mm);
    return;
  }
  ask("RMAC_CAM.FeedRetrace", {{"Distance", mm}});
}

void Prompt::park() {
  // Before the answer: the stop that parking is must not be taken for the program's end.
  parked_ = true;
  connection_.send("RMAC_CAM.ParkProgram", kNothing, [this](const Connection::Answer& answer) {
    if (refused(answer)) {
      parked_ = false;
      return;
    }
    connection_.send(kGetParkedProgram, kNothing, [this](const Connection::Answer& told) {
      // What was done just before may not have been told yet, and what is told from now on is not the program's.
      moves_.leave(told ? told->value("moves", moves_.size()) : moves_.size());
    });
    release();
  });
}

void Prompt::take_up() {
  connection_.send(kAcquireAuthority, kNothing, [this](const Connection::Answer& acquired) {
    if (refused(acquired)) return;
    connection_.send("RMAC_CAM.TakeUpProgram", kNothing, [this](const Connection::Answer& taken) {
      if (refused(taken)) {
        release();
        return;
      }
      parked_ = false;
      ask(kResumeFeed);
    });
  });
}

void Prompt::ask(const char* method, const nlohmann::json& params) {
  connection_.send(method, params, [this](const Connection::Answer& answer) { refused(answer); });
}

bool Prompt::refused(const Connection::Answer& answer) {
  if (answer) return false;
  note_ = answer.error().message;
  return true;
}

void Prompt::release() {
  connection_.send(kReleaseAuthority, kNothing, [](const Connection::Answer&) {});
}

}  // namespace rmac::cli
