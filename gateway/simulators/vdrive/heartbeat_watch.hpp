#pragma once

#include <array>
#include <cstdint>

#include "gateway/simulators/vdrive/outlet.hpp"

namespace rmac::vdrive {

/// The heartbeats of others that a node listens for (CiA 301, 7.2.8.3.2.2; 1016h).
class HeartbeatWatch {
 public:
  static constexpr std::uint8_t kWatched = 2;

  /// Sub-index 1 or 2 of 1016h was written: node and time.
  void configure(std::uint8_t sub, std::int64_t value);
  /// A frame of identifiers 701h to 77Fh.
  void hear(const CanFrame& heartbeat, Time now) noexcept;
  /// How many stopped by now, from the first heartbeat on; each is told once.
  [[nodiscard]] int lost(Time now) noexcept;

 private:
  struct Watched {
    std::uint8_t node = 0;
    Time limit{0};  ///< 0: not watched
    Time heard{0};
    bool runs = false;
  };
  std::array<Watched, kWatched> watched_;
};

}  // namespace rmac::vdrive
