#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <utility>

#include "gateway/queue/queue_step.hpp"
#include "gateway/state/cycle_sample.hpp"
#include "gateway/state/event.hpp"

namespace rmac::gateway {

/// Tells from samples which move began and which ended. Samples carry a count of moves done, so that nothing is missed
/// when some were dropped or many short moves end in one cycle. Gateway thread.
class MoveLedger {
 public:
  /// `still`: the move has no motion, so no sample counts it; it is done in its turn. The first part of a move tells
  /// that it began, the last one that it is done.
  /// `name`: as it is told; empty: "move 7". `since`: the cycle in which it was queued; a move without motion is told
  /// by a later sample, behind what ended in that cycle, or before the first event of a later `order`.
  void add(std::int64_t move_id, bool still, MovePart part = {}, std::string name = {}, std::int64_t since = -1,
           std::uint64_t order = 0) {
    moves_.push_back({move_id, !part.first, still, part.last, std::move(name), since, order});
  }
  /// What is not done will not be done.
  void clear() { moves_.clear(); }
  /// Another mechanism: its count begins at zero.
  void restart() {
    moves_.clear();
    done_ = 0;
  }
  using Tell = std::function<void(const Event&)>;
  void read(const CycleSample& sample, const Tell& tell);
  /// Tells of moves without motion whose turn had come before an event that is to be told now.
  void tell_before(const Event& event, const Tell& tell);

 private:
  struct Entry {
    std::int64_t id;
    bool started;  ///< told
    bool still;
    bool tells_done;
    std::string name;
    std::int64_t since;
    std::uint64_t order;
  };
  struct Moment {
    double t_s;
    std::int64_t cycle;
  };
  static void start(Entry& entry, const Moment& at, const Tell& tell);
  void end_front(const Moment& at, const Tell& tell);
  [[nodiscard]] bool front_is_done(const CycleSample& sample) const noexcept {
    const Entry& front = moves_.front();
    return front.still ? sample.cycle > front.since : done_ < sample.moves_done;
  }
  std::deque<Entry> moves_;
  std::uint64_t done_ = 0;
};

}  // namespace rmac::gateway
