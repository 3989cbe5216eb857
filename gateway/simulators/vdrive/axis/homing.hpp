#pragma once

#include <cstdint>

namespace rmac::vdrive {

/// What a drive sees of its axis while it looks for home.
struct HomingInputs {
  bool negative_limit = false;
  bool positive_limit = false;
  bool home_switch = false;
  bool index = false;     ///< the encoder's index pulse came since the step before
  bool standing = false;  ///< the demand is at rest
};

/// Looks for home by the methods of CiA 402-2, 13.3: 1 to 14 with the index pulse, 17 to 30 without, 33, 34, 35 and 37.
/// It sees switches and pulses, never positions, as a drive does.
class Homing {
 public:
  enum class State : std::uint8_t { Idle, Running, Attained, Failed };

  [[nodiscard]] static bool knows(int method) noexcept;

  /// Begins by a method that is known.
  void start(int method) noexcept;
  void stop() noexcept { phase_ = Phase::Idle; }

  /// One step. Returns the direction to move in: -1, 0 or 1.
  int step(const HomingInputs& inputs) noexcept;
  /// Towards the switch, rather than at the slow speed towards the zero.
  [[nodiscard]] bool fast() const noexcept {
    return (phase_ == Phase::Reach && !returning_) || phase_ == Phase::Clear || phase_ == Phase::Return;
  }
  /// True in the step in which home was found; the axis is still moving then.
  [[nodiscard]] bool found() const noexcept { return found_; }
  [[nodiscard]] State state() const noexcept;

 private:
  enum class Sensor : std::uint8_t { None, NegativeLimit, PositiveLimit, HomeSwitch };
  enum class Phase : std::uint8_t {
    Idle,
    Here,    ///< home is where it stands
    Reach,   ///< until the sensor closes
    Settle,  ///< to rest on it
    Clear,   ///< off it again, across the edge that counts
    Return,  ///< and back onto it, where it is to be left slowly
    Edge,    ///< slowly across the edge
    Index,   ///< slowly on to the index pulse
    Halt,    ///< home is found; to rest
    Attained,
    Failed
  };
  /// One row of the standard's figures.
  struct Method {
    Sensor sensor = Sensor::None;
    int first_direction = 0;  ///< of the search for the sensor
    int edge_direction = 0;   ///< in which its edge is crossed
    bool leaves = false;      ///< crossing the edge opens the sensor
    bool to_index = false;
  };

  [[nodiscard]] static Method method_of(int method) noexcept;
  [[nodiscard]] bool closed(const HomingInputs& inputs) const noexcept;
  /// Whether a limit switch that is not looked for ends the way in `direction`.
  [[nodiscard]] bool blocked(const HomingInputs& inputs, int direction) const noexcept;
  int reach(const HomingInputs& inputs) noexcept;
  void take_edge() noexcept;

  Method method_;
  Phase phase_ = Phase::Idle;
  int direction_ = 0;
  bool reversed_ = false;
  bool returning_ = false;  ///< it ran over the sensor and comes back slowly
  bool near_edge_ = false;  ///< it came onto the sensor across the edge that it is to leave by
  bool found_ = false;
};

}  // namespace rmac::vdrive
