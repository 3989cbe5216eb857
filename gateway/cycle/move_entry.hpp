#pragma once

#include "gateway/cycle/machine_cycle.hpp"

namespace rmac::gateway {

/// Where moves come in: they are built without a turn at the machine's cycle, and queued with one. Gateway thread.
class MoveEntry {
 public:
  explicit MoveEntry(MachineCycle& cycle) : cycle_(cycle) {}

  /// Refuses when a move cannot be taken now; then readies the path builder to begin where the machine stands, if it
  /// must.
  [[nodiscard]] Expected<> prepare();
  /// Builds and queues a move that `prepare` let through. False when there is nothing to move: such a move is done as
  /// soon as those before it are.
  [[nodiscard]] Expected<bool> add(const Move& move);
  /// The first half of it.
  [[nodiscard]] Expected<std::vector<BuiltMove>> build(const Move& move) {
    return build_moves(cycle_.builder(), {{&move, {}}});
  }

 private:
  MachineCycle& cycle_;
};

}  // namespace rmac::gateway
