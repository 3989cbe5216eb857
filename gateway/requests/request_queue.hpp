#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <string>
#include <string_view>

#include "gateway/requests/machine_aside.hpp"
#include "gateway/requests/request_line.hpp"
#include "gateway/requests/requester.hpp"
#include "gateway/requests/stop_mark.hpp"

namespace rmac::gateway {

/// The requests of one client that wait for their answers. They are carried out in the order in which they came, except
/// that stops overtake; a move that finds the machine's queue full waits for room, and those behind it with it; a
/// move that is refused has those behind it that have come already refused too. Gateway thread.
class RequestQueue {
 public:
  enum class Progress {
    Done,      ///< everything is answered
    TurnOver,  ///< more can be carried out, but others come first
    Waits      ///< for room in the machine's queue, for the machine, or for what is away: the next tick goes on
  };

  /// `queue_wait` is how long a move waits for room.
  RequestQueue(Requester& client, Dispatcher& dispatcher, MachineAside& aside, std::chrono::milliseconds queue_wait);

  /// From now on refuses all but stops, and the greeting, because of `why`.
  void take_only_stops(std::string why) { only_stops_ = std::move(why); }
  /// Takes a line, which begins at `position` of the client's input: its stops are carried out at once.
  void take(std::string_view line, std::uint64_t position);
  /// Carries out what waits, as far as it goes.
  [[nodiscard]] Progress carry_out();
  /// A stop that `name` names took effect: what stands before `position` of the input must start nothing.
  void stopped(Effect stop, const std::string& name, std::uint64_t position) { stop_mark_.set(stop, name, position); }
  /// Drops what waits, unanswered.
  void clear() noexcept {
    lines_.clear();
    bytes_ = 0;
  }

  [[nodiscard]] bool empty() const noexcept { return lines_.empty(); }
  /// Length of the lines that wait.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }

 private:
  using Line = std::shared_ptr<RequestLine>;  // kept by what is away with it, too

  void stop_first(RequestLine& line);
  [[nodiscard]] bool carry_out(const Line& line);
  void carry_out_aside(const Line& line, const Request& request);
  [[nodiscard]] std::optional<Answer> refusal_of(const RequestLine& line, const Request& request) const;
  /// Notes the answer to the next request. False when that is a move that must be tried again.
  [[nodiscard]] bool settle(RequestLine& line, Answer answer);
  /// Whether a move that found the queue full is tried again.
  [[nodiscard]] bool must_wait(const RequestLine& line) const;
  void answer(const RequestLine& line);

  Requester& client_;
  Dispatcher& dispatcher_;
  MachineAside& aside_;
  std::chrono::milliseconds queue_wait_;
  std::deque<Line> lines_;
  std::size_t bytes_ = 0;
  StopMark stop_mark_;
  std::optional<std::string> only_stops_;  ///< why nothing else is carried out, where it is not
};

}  // namespace rmac::gateway
