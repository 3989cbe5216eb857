#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>

#include "gateway/rmac/program/program.hpp"

namespace rmac::cli {

/// The moves and tool changes of a program that were sent and are not done, in order, and the time that those before
/// them took. Events of moves that are not the program's change nothing.
class UnfinishedMoves {
 public:
  /// A request of timing `Move` goes out.
  void sent(const Request& request);

  /// A move began, is done, and a tool was changed; times are the machine's.
  void started(double t_s);
  void done(std::int64_t move_id, double t_s);
  void tool_changed();
  /// All but the last `to_do` are done, though nobody told when.
  void leave(std::size_t to_do);

  [[nodiscard]] bool empty() const noexcept { return unfinished_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return unfinished_.size(); }
  /// Line of the first one; none when all are done.
  [[nodiscard]] std::optional<int> line() const;

  [[nodiscard]] std::size_t moves_done() const noexcept { return moves_done_; }
  [[nodiscard]] std::size_t tools_changed() const noexcept { return tools_changed_; }
  /// From the first move's start to the last one's end.
  [[nodiscard]] double cycle_time_s() const noexcept { return cycle_time_s_; }
  [[nodiscard]] double last_done_s() const noexcept { return last_done_s_; }

 private:
  struct Entry {
    std::int64_t id = 0;
    int line = 0;
    bool tool_change = false;
  };

  std::deque<Entry> unfinished_;
  std::size_t moves_done_ = 0, tools_changed_ = 0;
  std::optional<double> first_start_s_;
  double cycle_time_s_ = 0, last_done_s_ = 0;
};

}  // namespace rmac::cli
