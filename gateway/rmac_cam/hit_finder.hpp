#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/controller/machine_state.hpp"

namespace rmac::gateway {

/// Finds the joints at the instant of a hit: the probe's time stamp lies between two cycles, and measured positions
/// around it are joined by a cubic. So a hit is as exact as the encoders, however far a joint goes in a cycle.
class HitFinder {
 public:
  struct Found {
    double t_s = 0;
    std::vector<double> joints;
  };
  /// Every sample, in order. A hit is found one sample after the one that counts it.
  [[nodiscard]] std::optional<Found> read(const CycleSample& sample);
  /// Another mechanism: what was read before says nothing.
  void restart() noexcept { *this = HitFinder{}; }

 private:
  struct Node {
    double t_s = 0;
    std::array<double, kMaxJoints> position{};
  };
  [[nodiscard]] Found interpolate(double t_s, std::size_t joints) const;

  std::array<Node, 4> nodes_{};  ///< the latest last
  std::size_t count_ = 0;
  std::uint32_t hits_ = 0;
  std::optional<double> hit_t_s_;
};

}  // namespace rmac::gateway
