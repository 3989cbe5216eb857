#pragma once

#include <array>
#include <cstddef>
#include <span>

namespace rmac {

/// Motion of one joint at one instant, in its units (mm or deg) and s.
struct JointState {
  double position = 0;
  double velocity = 0;
  double acceleration = 0;
};

/// Bounds of one joint. The minima are below zero, the others above it, all finite.
struct MotionBounds {
  double min_velocity = 0;
  double max_velocity = 0;
  double min_acceleration = 0;
  double max_acceleration = 0;
  double max_jerk = 0;
};

/// A motion of constant jerks, one after the other. Plain data; `at` is real-time safe.
class JerkProfile {
 public:
  struct Phase {
    double t0 = 0;  ///< since the profile's begin
    JointState start;
    double jerk = 0;
  };
  static constexpr std::size_t kMaxPhases = 20;

  JerkProfile() = default;
  explicit JerkProfile(const JointState& from) noexcept;

  /// Goes on with a constant jerk; a phase without duration is left out.
  void append(double duration, double jerk) noexcept;

  [[nodiscard]] double duration() const noexcept { return duration_; }
  [[nodiscard]] const JointState& end() const noexcept { return end_; }
  [[nodiscard]] std::span<const Phase> phases() const noexcept { return {phases_.data(), count_}; }
  /// The state at t, at the ends for a t outside of the profile.
  [[nodiscard]] JointState at(double t) const noexcept;

 private:
  std::array<Phase, kMaxPhases> phases_;
  std::size_t count_ = 0;
  double duration_ = 0;
  double peak_ = 0;  ///< of the acceleration's magnitude
  JointState end_;
};

/// The fastest motion from any state to any state (docs/derivations/state-to-state.md). A state outside of the bounds
/// is brought inside as fast as they allow, and left likewise at the end; all else stays inside. Real-time safe.
[[nodiscard]] JerkProfile fastest_profile(const JointState& from, const JointState& to,
                                          const MotionBounds& bounds) noexcept;

/// The fastest motion to a velocity that is then kept, wherever that is. Real-time safe.
[[nodiscard]] JerkProfile velocity_profile(const JointState& from, double velocity,
                                           const MotionBounds& bounds) noexcept;

/// Motions of several joints that begin and end together, in the least duration that all of them can take: each joint
/// has durations that it cannot, so it may be longer than that of the slowest. Returns the duration. Real-time safe.
double synchronise(std::span<const JointState> from, std::span<const JointState> to,
                   std::span<const MotionBounds> bounds, std::span<JerkProfile> profiles) noexcept;

}  // namespace rmac
