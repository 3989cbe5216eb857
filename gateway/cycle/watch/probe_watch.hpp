#pragma once

#include <cstddef>
#include <optional>

#include "gateway/cycle/watch/measurement.hpp"
#include "gateway/state/stop_cause.hpp"

namespace rmac::gateway {

/// Watches the touch probe: a point that is measured, and hits that nobody asked for. In virtual mode, where nothing
/// can touch, it watches a probe that is simulated. One thread at a time: the caller locks.
class ProbeWatch {
 public:
  struct Seen {
    std::size_t moves_left = 0;
    bool at_rest = true;
    ProbeReport probe{};     ///< the real one
    bool positions = false;  ///< a move outside of the cycle is under way
    bool given_up = false;   ///< the machine is faulted, or its queue is being emptied: nothing is measured any more
  };
  struct Verdict {
    bool touched = false;           ///< as it should: the search or the jog ends here
    std::optional<StopCause> stop;  ///< and empty the queue
  };

  /// Another mechanism went in; its probe counts on from `probe`.
  void install(bool simulated, const ProbeReport& probe) noexcept;
  [[nodiscard]] Measurement& measurement() noexcept { return measurement_; }
  [[nodiscard]] const Measurement& measurement() const noexcept { return measurement_; }
  /// The simulated probe is deflected, or let go.
  void simulate(bool touching) noexcept;
  [[nodiscard]] Verdict step(const Seen& seen) noexcept;

 private:
  Measurement measurement_;
  bool simulated_ = false;
  ProbeReport simulated_probe_{.ready = true, .touching = false, .hits = 0, .hit_before_s = 0};
};

}  // namespace rmac::gateway
