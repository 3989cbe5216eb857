#pragma once

#include <vector>

namespace rmac {

/// Where a joint really stands beyond where its drive shows it, point by point along the travel: the error of a screw's
/// pitch, as a laser finds it. Straight between points, steady beyond the ends. Empty: none.
struct PitchErrors {
  double first = 0;              ///< mm or deg shown by the drive
  double step = 0;               ///< between points, above 0
  std::vector<double> errors{};  ///< mm or deg, one a point
};

/// A resonance of the mechanics between motor and load, which a notch filter keeps the drive from exciting.
struct Resonance {
  double frequency_hz = 0;
  double damping = 0;  ///< of the resonance, above 0 and below `width`
  double width = 0.5;  ///< damping of the filter's poles: how far around it acts
};

/// What `device.json` says of the mechanics of one joint, for the servo loop to make good.
struct JointMechanics {
  PitchErrors pitch{};
  double backlash = 0;  ///< mm or deg; the joint lags its drive by half of it, whichever way it went last
  std::vector<Resonance> resonances{};
  double low_pass_hz = 0;  ///< of the effort, second order; 0: none
};

}  // namespace rmac
