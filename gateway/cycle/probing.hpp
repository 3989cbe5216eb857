#pragma once

#include <optional>

#include "gateway/cycle/machine_cycle.hpp"

namespace rmac::gateway {

/// Points measured by touch, as the gateway commands them; the machine's cycle stops a search where the probe touches.
/// Gateway thread.
class Probing {
 public:
  explicit Probing(MachineCycle& cycle) : cycle_(cycle) {}

  /// Adds a point to be measured, which `MoveEntry::prepare` let through: the approach, if there is one, and the
  /// search, which both begin and end at rest. Nothing can be queued behind it until it is done, because it ends where
  /// it finds the part.
  [[nodiscard]] Expected<> add(const std::optional<Move>& approach, const Move& search);
  /// Once the measurement stands after its hit: adds the way back from there. Without effect before.
  [[nodiscard]] Expected<> add_retract(const Move& move);
  [[nodiscard]] Measurement::Phase phase();
  /// Hits of a person who jogs are expected.
  void expect_hits_by_hand(bool expected);
  /// In virtual mode, where nothing can touch: the probe is deflected, or let go.
  void simulate(bool touching);

 private:
  /// False when the measurement does not stand after its hit.
  [[nodiscard]] Expected<bool> ready_for_retract();
  /// What is queued before it is not only moves.
  [[nodiscard]] bool waits_for_steps();

  MachineCycle& cycle_;
};

}  // namespace rmac::gateway
