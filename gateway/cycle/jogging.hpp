#pragma once

#include <optional>

#include "gateway/cycle/machine_cycle.hpp"
#include "gateway/cycle/move_entry.hpp"

namespace rmac::gateway {

/// Moves outside of the cycle, from rest and with an empty queue: positioning, and jogs that last while somebody asks
/// for them. Gateway thread.
class Jogging {
 public:
  Jogging(MachineCycle& cycle, MoveEntry& entry) : cycle_(cycle), entry_(entry) {}

  /// Builds, adds and runs one move. With `share` it is a jog that lasts while `renew` says so, at this share of the
  /// move's speed.
  [[nodiscard]] Expected<> run(const Move& move, std::optional<double> share = std::nullopt);
  /// Keeps the jog under way going, at `share` of its move's speed; false when none is.
  [[nodiscard]] bool renew(double share);
  /// Stops the jog under way, if there is one.
  [[nodiscard]] Expected<> end();

 private:
  /// Refuses when no such move may begin now; otherwise the next move begins where the machine stands.
  [[nodiscard]] Expected<> begin();
  /// Queues what was built, and runs it.
  [[nodiscard]] Expected<> start(std::vector<BuiltMove> built, std::optional<double> share);

  MachineCycle& cycle_;
  MoveEntry& entry_;
};

}  // namespace rmac::gateway
