#pragma once

#include <functional>

#include "rmac/fieldbus/canopen/canopen_interface.hpp"

namespace rmac::fieldbus::canopen {

/// A first motion of one drive, by itself, to see that it is wired and set up as it should be.
struct DriveTrial {
  DriveMode mode = DriveMode::ProfilePosition;
  /// Modes of position: the way to go, in counts. Of velocity: in the drive's units. Of torque: in per mille of the
  /// rated one.
  std::int32_t amount = 0;
  double seconds = 1;            ///< that the way takes in cyclic modes of position, and that velocity and torque last
  std::int64_t most_counts = 0;  ///< from where it stood; beyond them it is stopped
  /// Modes of position: counts off the place asked for at which the drive still has reached it. 0: a hundredth of the
  /// way, at least ten counts.
  std::int64_t tolerance_counts = 0;
};

struct DriveTrialResult {
  std::int32_t from_counts = 0;
  std::int32_t to_counts = 0;        ///< at the end of the way, before the power went
  std::int64_t farthest_counts = 0;  ///< from where it stood, by its amount
  double seconds = 0;                ///< under way
};

/// Enables the one drive of a started `bus`, moves it as `trial` says, and disables it again, whatever happens. `pass`
/// waits for the next cycle. Refuses a drive that is not at rest, and a trial that could go nowhere; the error says
/// what the drive did instead. A drive that says it is through and stands elsewhere (a limit switch, a quick stop of
/// its own) has failed.
[[nodiscard]] Expected<DriveTrialResult> try_drive(CanopenInterface& bus, const CanopenConfig& config,
                                                   const DriveTrial& trial, const std::function<void()>& pass);

}  // namespace rmac::fieldbus::canopen
