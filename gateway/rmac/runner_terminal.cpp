// What a person says at the terminal of `rmac run`; parking a program, so that others may use the machine, included.
#include <fmt/format.h>

#include <charconv>

#include "gateway/rmac/runner.hpp"

namespace rmac::cli {

namespace {

const nlohmann::json kNothing = nlohmann::json::object();

}  // namespace

void Runner::obey(const std::string& line) {
  // Whoever holds a program from another terminal cannot resume it there: this client has the lease.
  const auto tell = [this](const Connection::Answer& answer) {
    if (!answer) note_ = answer.error().message;
  };
  note_.clear();
  if (line.empty() && state_ && !state_->tool_prompt.empty()) {
    connection_.send("RMAC_CAM.ConfirmToolChange", {{"ToolNumber", state_->tool_wanted}}, tell);
    return;
  }
  if (line == "p" && !parked_) {
    park();
    return;
  }
  if (parked_) {
    if (line.empty()) take_up();
    return;
  }
  if (line.empty()) {
    connection_.send("RMAC_CAM.FeedResume", nlohmann::json::object(), [](const Connection::Answer&) {});
    return;
  }
  double distance_mm = 0;
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), distance_mm);
  if (error != std::errc() || end != line.data() + line.size()) {
    note_ = fmt::format("\"{}\" is no distance in mm", line);
    return;
  }
  connection_.send("RMAC_CAM.FeedRetrace", {{"Distance", distance_mm}}, tell);
}

void Runner::park() {
  // Before the answer: the stop that parking is must not be taken for the program's end.
  parked_ = true;
  connection_.send("RMAC_CAM.ParkProgram", kNothing, [this](const Connection::Answer& answer) {
    if (!answer) {
      parked_ = false;
      note_ = answer.error().message;
      return;
    }
    connection_.send("RMAC_CAM.GetParkedProgram", kNothing, [this](const Connection::Answer& told) {
      // What was done just before may not have been told yet, and what is told from now on is not the program's.
      const std::size_t to_do = told ? told->value("moves", unfinished_.size()) : unfinished_.size();
      for (; unfinished_.size() > to_do; unfinished_.pop_front()) ++report_.moves;
    });
    connection_.send("authority.release", kNothing, [](const Connection::Answer&) {});
  });
}

void Runner::take_up() {
  const auto refused = [this](const Connection::Answer& answer) {
    if (answer) return false;
    note_ = answer.error().message;
    return true;
  };
  connection_.send("authority.acquire", kNothing, [this, refused](const Connection::Answer& acquired) {
    if (refused(acquired)) return;
    connection_.send("RMAC_CAM.TakeUpProgram", kNothing, [this, refused](const Connection::Answer& taken) {
      if (refused(taken)) {
        connection_.send("authority.release", kNothing, [](const Connection::Answer&) {});
        return;
      }
      parked_ = false;
      connection_.send("RMAC_CAM.FeedResume", kNothing, refused);
    });
  });
}

}  // namespace rmac::cli
