#pragma once

#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "rmac/motion/ports/servo_law.hpp"

namespace rmac::verifier {

struct ServoLawCase {
  std::vector<double> gains;
  std::vector<double> other_gains;  ///< that it takes too; empty: `gains` again
  std::uint64_t seed = 1;
  double period_s = 0.001;  ///< of the servo loop that it is to run in
};

/// What every servo law must keep, over seeded random inputs at that period: its gains are named, wrong ones change
/// nothing, its output stays within the limit and does not wind up at it, engaging continues from the effort given, new
/// gains do not make it jump, NaN and infinity come out as no number and leave nothing behind, and at rest it goes on
/// with the effort that it says holds the joint.
[[nodiscard]] Checked check_servo_law(ServoLaw& law, const ServoLawCase& given);

}  // namespace rmac::verifier
