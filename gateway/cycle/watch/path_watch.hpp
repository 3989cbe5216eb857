#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "rmac/motion/follower/path_departure.hpp"

namespace rmac::gateway {

/// Sees that motion gets on when it should, and that the joints stay on their path. A pure state machine.
class PathWatch {
 public:
  struct Seen {
    double t_s = 0;
    bool should_move = false;  ///< told to, with moves queued, an override above 0, and nothing to wait for
    std::int64_t move_id = 0;
    double s_mm = 0;
    PathDeparture departure{};
  };

  /// What is wrong, for a person; each thing once.
  [[nodiscard]] std::optional<std::string> step(const Seen& seen);
  /// Another mechanism went in, whose departures count from 0.
  void restart() noexcept { *this = {}; }

 private:
  [[nodiscard]] bool stands(const Seen& seen) noexcept;

  std::uint64_t departures_ = 0;
  std::int64_t move_id_ = -1;
  double s_mm_ = 0;
  double stood_s_ = 0;
  double looked_at_s_ = std::numeric_limits<double>::infinity();
};

}  // namespace rmac::gateway
