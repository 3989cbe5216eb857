#pragma once

#include <asio/buffer.hpp>
#include <chrono>
#include <deque>
#include <string>
#include <vector>

namespace rmac::gateway {

/// The lines that wait for being written to a client, and how long it has read none of them.
class Outbox {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Outbox(Time now) : last_progress_(now) {}

  /// Adds a line; its newline is put in here.
  void add(std::string line, Time now);
  /// What to write next: empty while a write is under way, or when there is nothing. The buffers last until `written`.
  [[nodiscard]] std::vector<asio::const_buffer> begin_write();
  void written(Time now);

  [[nodiscard]] bool empty() const noexcept { return lines_.empty(); }
  /// Memory of the lines that wait or are being written.
  [[nodiscard]] std::size_t bytes() const noexcept { return bytes_; }
  /// How long nothing was read of what waits.
  [[nodiscard]] Time::duration standstill(Time now) const noexcept { return now - last_progress_; }

 private:
  std::deque<std::string> lines_;
  std::size_t bytes_ = 0;
  std::size_t writing_ = 0;  ///< lines in the write under way
  Time last_progress_;
};

}  // namespace rmac::gateway
