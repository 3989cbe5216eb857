#pragma once

#include <array>
#include <cstdint>

#include "rmac/motion/machine_size.hpp"

namespace rmac {

/// A digital input that a drive tells.
struct ServoDriveInput {
  std::uint32_t actuator = 0;
  std::uint32_t drive_bit = 0;  ///< mask, of the drive's inputs
  std::uint64_t input = 0;      ///< mask, of the machine's
};

/// A limit switch at one end of a joint's travel. While it is on the joint does not move on towards it.
struct ServoLimit {
  std::uint64_t input = 0;  ///< mask; one of `limit_inputs`
  std::uint32_t joint = 0;
  int direction = 0;  ///< 1: at the upper end; -1: at the lower one
};

/// A touch probe among the inputs.
struct ServoProbe {
  std::uint64_t touch_input = 0;  ///< its bit is 1 while the probe is deflected; 0: there is no probe
  std::uint64_t ready_input = 0;  ///< on while the probe has power; 0: it does not tell
  double settle_s = 0.005;        ///< a contact that opens for less has not let go: it bounces
};

/// What the probe tells in one cycle.
struct ProbeReport {
  bool ready = false;       ///< there is one, and it has power as far as it tells
  bool touching = false;    ///< from its first contact until it has let go for its settling time
  std::uint32_t hits = 0;   ///< first contacts so far; wraps
  double hit_before_s = 0;  ///< how long before the cycle's measurement the last one was, in the cycle that counts it
  std::uint32_t latching = 0;                         ///< bit i: the drives of joint i latch their positions at a hit
  std::uint32_t latched = 0;                          ///< bit i: they have, at the last one; until the probe has let go
  std::array<double, kMaxJoints> latched_position{};  ///< of those joints
};

}  // namespace rmac
