#pragma once

#include <cstdint>
#include <vector>

#include "rmac/motion/error.hpp"
#include "rmac/motion/pose.hpp"

namespace rmac::sdk {

/// What a measuring machine is about; values as on the wire (ControlMode of Appendix IV).
enum class ControlMode : std::uint8_t {
  Inactive = 0,          ///< no measuring: AutoMeasure and ManualMeasure are refused
  Manual = 1,            ///< a person jogs, and hits are expected
  AutomaticMove = 2,     ///< moves run, and a hit is an error
  AutomaticMeasure = 3,  ///< a point is being measured
  Startup = 4,
  Shutdown = 5,
};

/// Values as on the wire (Parameter of Appendix IV): mm, and mm/s.
enum class MeasureParameter : std::uint8_t {
  PrehitDistance = 0,
  SearchDistance = 1,
  RetractDistance = 2,
  ScanSpeed = 3
};

/// A contact of the probe.
struct Hit {
  double t_s = 0;
  std::vector<double> joints;  ///< at that instant: mm or degrees
  ToolPose pose;               ///< of the tool at these joints, in the part frame
};

/// A bit of a machine's condition: the probe is deflected.
inline constexpr std::uint64_t kConditionProbe = 1;

/// The measuring part of RMAC_CAM (Appendix IV, 5.2.3), on whatever mechanism is loaded: it moves by the kinematics and
/// the joints of that. Speeds are mm/s. Gateway thread only.
class Measuring {
 public:
  virtual ~Measuring() = default;

  /// Queues the measurement of a point: straight towards it at `speed` as far as the prehit distance, on at the scan
  /// speed until the probe touches or the search distance beyond is done, and back by the retract distance.
  virtual Expected<> auto_measure(std::int64_t id, const Vector& point, double speed) = 0;
  /// From now on a person jogs, and hits are expected.
  virtual Expected<> manual_measure() = 0;
  /// Spins the spindle for some seconds and stops it, which switches the probe. From rest.
  virtual Expected<> spin_probe(double rpm, double seconds) = 0;
  /// In virtual mode: the probe is deflected with the joints there, or has let go.
  virtual Expected<> simulate_probe(std::vector<double> joints, bool touching) = 0;
  /// The part frame goes where the tool tip is, its Z along the tool axis. At rest.
  virtual Expected<> set_calibrated_part_frame() = 0;

  /// The last hit; the error says that there was none. `new_hit` is false from then on.
  virtual Expected<Hit> last_hit() = 0;
  [[nodiscard]] virtual bool new_hit() const = 0;
  [[nodiscard]] virtual bool probe_active() const = 0;
  [[nodiscard]] virtual ControlMode control_mode() const = 0;
  virtual Expected<> set_control_mode(ControlMode mode) = 0;
  [[nodiscard]] virtual double parameter(MeasureParameter number) const = 0;
  virtual Expected<> set_parameter(MeasureParameter number, double value) = 0;
};

}  // namespace rmac::sdk
