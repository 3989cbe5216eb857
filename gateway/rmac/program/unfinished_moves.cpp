#include "gateway/rmac/program/unfinished_moves.hpp"

namespace rmac::cli {

void UnfinishedMoves::sent(const Request& request) {
  unfinished_.push_back({request.move_id, request.line, request.tool_change});
}

void UnfinishedMoves::started(double t_s) {
  if (!first_start_s_ && !unfinished_.empty()) first_start_s_ = t_s;
}

void UnfinishedMoves::done(std::int64_t move_id, double t_s) {
  if (unfinished_.empty() || unfinished_.front().tool_change || unfinished_.front().id != move_id) return;
  unfinished_.pop_front();
  ++moves_done_;
  last_done_s_ = t_s;
  cycle_time_s_ = t_s - first_start_s_.value_or(t_s);
}

void UnfinishedMoves::tool_changed() {
  if (unfinished_.empty() || !unfinished_.front().tool_change) return;
  unfinished_.pop_front();
  ++tools_changed_;
}

void UnfinishedMoves::leave(std::size_t to_do) {
  for (; unfinished_.size() > to_do; unfinished_.pop_front()) ++moves_done_;
}

std::optional<int> UnfinishedMoves::line() const {
  return unfinished_.empty() ? std::nullopt : std::optional(unfinished_.front().line);
}

}  // namespace rmac::cli
