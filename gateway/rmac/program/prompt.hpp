#pragma once

#include <functional>
#include <optional>
#include <string>

#include "gateway/rmac/program/unfinished_moves.hpp"
#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/notes.hpp"

namespace rmac::cli {

/// The person at the terminal of `rmac run`. A line without words goes on after a hold or confirms a tool, a number of
/// mm runs back along the path, and p parks the program, so that others may use the machine.
class Prompt {
 public:
  /// Both outlive the prompt. Parking asks the appliance how many of `moves` it has still to do.
  Prompt(Connection& connection, UnfinishedMoves& moves) : connection_(connection), moves_(moves) {}

  /// A line that was entered.
  void obey(const std::string& line);
  /// What the machine does now.
  void hear(StateNote state) { state_ = std::move(state); }

  /// The program is set aside: nothing of it is sent, and what the machine does is somebody else's.
  [[nodiscard]] bool parked() const noexcept { return parked_; }
  /// What to tell beside the progress: what a person may do now, what was wrong with the last line, or the feed.
  [[nodiscard]] std::string text() const;

 private:
  void park();
  void take_up();
  void hold();
  /// A distance to run back, or a feed override.
  void take_number(const std::string& line);
  /// What `send` sends is the operator's, where nobody else is.
  void as_operator(const std::function<void()>& send);
  /// Sends a request whose refusal is told beside the progress.
  void ask(const char* method, const nlohmann::json& params = nlohmann::json::object());
  /// Notes the refusal, if the answer is one.
  bool refused(const Connection::Answer& answer);
  /// Gives motion authority back, whatever comes of it.
  void release();

  Connection& connection_;
  UnfinishedMoves& moves_;
  std::optional<StateNote> state_;
  std::string note_;  ///< what was wrong with the last line
  bool parked_ = false;
};

}  // namespace rmac::cli
