#pragma once

#include <cstddef>
#include <cstdint>

#include "rmac/motion/servo/servo_inputs.hpp"

namespace rmac::gateway {

/// One point measured by touch: the approach, the search at whose end the probe touches, the way back. Also tells hits
/// that nobody asked for. A pure state machine: the probe watch steps it.
class Measurement {
 public:
  enum class Phase : std::uint8_t {
    None,
    Approach,  ///< queued, or on its way to where the search begins
    Search,
    Touched,   ///< coming to rest after the hit
    Standing,  ///< at rest; the way back has not been queued yet
    Retract,
  };
  struct Seen {
    std::size_t moves_left = 0;
    bool at_rest = true;
    ProbeReport probe;
  };
  enum class Verdict : std::uint8_t {
    Nothing,
    Touched,        ///< as it should: stop here
    NotFound,       ///< the search ended without a hit
    ProbeLost,      ///< the probe lost its power
    Unexpected,     ///< a hit in motion that is no search
    NotArmed,       ///< deflected before it touched: it could not tell of a hit
    StillTouching,  ///< after the way back
    Done,
  };

  /// `steps`: moves of the approach and the search, which are the last in the queue.
  void begin(std::size_t steps) noexcept;
  /// The way back has been queued.
  void retract() noexcept;
  void abandon() noexcept { phase_ = Phase::None; }
  [[nodiscard]] Phase phase() const noexcept { return phase_; }
  [[nodiscard]] bool pending() const noexcept { return phase_ != Phase::None; }
  /// Moves of the queue that are its own.
  [[nodiscard]] std::size_t steps() const noexcept { return steps_; }
  /// Hits in motion are expected while it is so.
  void expect_by_hand(bool expected) noexcept { by_hand_ = expected; }
  /// Another probe: its count begins elsewhere.
  void count_from(std::uint32_t hits) noexcept { hits_ = hits; }
  [[nodiscard]] Verdict step(const Seen& seen) noexcept;

 private:
  [[nodiscard]] Verdict search(const Seen& seen, bool hit) noexcept;

  Phase phase_ = Phase::None;
  std::size_t steps_ = 0;
  std::uint32_t hits_ = 0;
  bool by_hand_ = false;
};

}  // namespace rmac::gateway
