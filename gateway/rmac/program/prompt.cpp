#include "gateway/rmac/program/prompt.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string_view>

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
  } else if (line == "h") {
    hold();
  } else if (parked_) {
    if (line.empty()) take_up();
  } else if (line == "p") {
    park();
  } else if (line.empty()) {
    as_operator([this] { ask(kResumeFeed); });
  } else {
    take_number(line);
  }
}

std::string Prompt::text() const {
  if (!state_) return note_;
  if (!state_->tool_prompt.empty()) return state_->tool_prompt + ", or Enter";
  if (parked_) return note_.empty() ? "parked: Enter takes it up again" : note_;
  if (!note_.empty()) return note_;
  const bool held = state_->is(gateway::CycleState::Holding);
  if (held) {
    return fmt::format("{}: Enter goes on, a distance in mm runs back, p parks",
                       state_->stop_prompt.empty() ? "held" : state_->stop_prompt);
  }
  return fmt::format("{:.0f} mm/min, {:.0f} %: h holds, 50% slows down", state_->feed_actual, state_->override_percent);
}

void Prompt::take_number(const std::string& line) {
  double number = 0;
  const char* const end_of_line = line.data() + line.size();
  const auto [end, error] = std::from_chars(line.data(), end_of_line, number);
  if (error == std::errc() && end == end_of_line) {
    as_operator([&] { ask("RMAC_CAM.FeedRetrace", {{"Distance", number}}); });
  } else if (error == std::errc() && std::string_view(end, end_of_line) == "%") {
    as_operator([&] { ask(kSetOverride, {{"Percent", number}}); });
  } else {
    note_ = fmt::format("\"{}\" is no distance in mm, and no feed override as 50%", line);
  }
}

void Prompt::as_operator(const std::function<void()>& send) {
  // Where another is the operator, what this client may do by its lease it does all the same.
  connection_.send(kAcquireOperator, kNothing, [](const Connection::Answer&) {});
  send();
  connection_.send(kReleaseOperator, kNothing, [](const Connection::Answer&) {});
}

void Prompt::hold() {
  // At once; then once more as the operator. Sent together with the request for the place, it would overtake that.
  ask(kHoldFeed);
  connection_.send(kAcquireOperator, kNothing, [this](const Connection::Answer& acquired) {
    if (!acquired) return;
    ask(kHoldFeed);
    connection_.send(kReleaseOperator, kNothing, [](const Connection::Answer&) {});
  });
}

void Prompt::park() {
  // Before the answer: the stop that parking is must not be taken for the program's end.
  parked_ = true;
  as_operator([this] {
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
      as_operator([this] { ask(kResumeFeed); });
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
