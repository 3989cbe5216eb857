#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/api/dispatch/dispatcher.hpp"

namespace rmac::gateway {

/// The requests of one line, alone or as a batch, and the answers that they have so far. One thread at a time.
class RequestLine {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Reading a longer line takes milliseconds.
  static constexpr std::size_t kLongBytes = 64U << 10U;

  enum class Stage {
    Here,      ///< its next request can be carried out
    Prepared,  ///< and what comes before that is done already
    Away       ///< on the thread beside the gateway's: being read, or its next request carried out
  };

  /// `position` is the line's in the client's input; its requests count on from there.
  RequestLine(std::uint64_t position, std::size_t bytes, Time received);

  /// Makes the requests of the text. A line that holds none still gets its answer in its turn.
  void read(std::string_view text);

  /// Answers the stops in it, before anything that waits.
  void answer_stops(const std::function<Answer(const Request& stop, std::uint64_t position)>& carry_out);
  /// Whether it is one request, no batch, that is answered.
  [[nodiscard]] bool is_answered_alone() const;

  /// The first request without an answer, or nullptr.
  [[nodiscard]] const Request* next();
  [[nodiscard]] std::uint64_t next_position() const noexcept { return position_ + next_; }
  /// Why the next request must not run because of what came before it in its batch or line, if so.
  [[nodiscard]] std::optional<Answer> refusal_of_next() const;
  void answer_next(Answer answer);

  /// A move before these was refused, and what they are to be told: taking a later one would leave a gap.
  void refuse_moves(const Answer& refusal) { refuses_moves_ = refusal; }
  [[nodiscard]] bool refuses_moves() const noexcept { return refuses_moves_.has_value(); }

  /// The line that answers it, where it wants an answer. Every request must have its own.
  [[nodiscard]] std::optional<std::string> response() const;

  [[nodiscard]] Stage stage() const noexcept { return stage_; }
  void set_stage(Stage stage) noexcept { stage_ = stage; }
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] Time received() const noexcept { return received_; }

 private:
  std::uint64_t position_;
  std::size_t bytes_;
  Time received_;
  Stage stage_ = Stage::Here;
  bool batch_ = false;
  std::optional<Answer> refuses_moves_;
  std::vector<Request> requests_;
  std::vector<std::optional<Answer>> answers_;
  std::size_t next_ = 0;
  std::size_t answer_bytes_ = 0;  ///< of a batch's answers so far
};

/// The answer of a machine that refuses.
[[nodiscard]] Answer refused(MinorCode minor, std::string message);

}  // namespace rmac::gateway
