#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "gateway/state/cycle_sample.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"

namespace rmac::gateway {

/// Finds the joints at the instant of a hit. Where drives have latched their positions, those are they. Other joints
/// are taken from the positions measured in the cycles around the instant, joined by a cubic: the probe's time stamp
/// lies between two cycles, so a hit is as exact as the encoders, however far a joint goes in a cycle, and however many
/// cycles its drive is behind in telling. Without a stamp, the instant is that in which a joint passed the position
/// that its drive latched.
class HitFinder {
 public:
  struct Found {
    double t_s = 0;
    std::vector<double> joints;
  };
  /// Every sample, in order. A hit is found one sample after the one that counts it, or some more where drives still
  /// have to tell where they were, or what they latched.
  [[nodiscard]] std::optional<Found> read(const CycleSample& sample);
  /// Another mechanism: what was read before says nothing.
  void restart() noexcept { *this = HitFinder{}; }

 private:
  struct Node {
    double t_s = 0;
    std::array<double, kMaxJoints> position{};
  };
  struct Hit {
    double t_s = 0;
    bool stamped = false;
    std::uint32_t latching = 0;  ///< joints whose drives latch it
    int samples = 0;             ///< since the one that counted it
    std::vector<Node> around;    ///< what was told in the cycles about it, and until the last drive has told
  };
  static constexpr std::size_t kNodes = 4;
  [[nodiscard]] static double joint_at(const std::vector<Node>& around, std::size_t joint, std::size_t delay,
                                       double t_s);
  [[nodiscard]] static double passing(const std::vector<Node>& around, std::size_t joint, std::size_t delay,
                                      double position, double t_s);
  [[nodiscard]] static Found find(const Hit& hit, const CycleSample& sample);

  std::array<Node, kNodes + kMostAnswerDelay> nodes_{};  ///< the latest last
  std::size_t count_ = 0;
  std::uint32_t hits_ = 0;
  std::optional<Hit> hit_;
};

}  // namespace rmac::gateway
