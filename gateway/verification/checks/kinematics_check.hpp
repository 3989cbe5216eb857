#pragma once

#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::verifier {

struct JointRange {
  double min = 0;
  double max = 0;
};

struct KinematicsCase {
  std::vector<JointRange> ranges;        ///< of each joint: where samples are taken
  std::vector<Frame> tools = {Frame{}};  ///< that the machine can carry
  int samples = 100'000;
  std::uint64_t seed = 1;
  Misdeed misdeed{};
};

/// What every kinematics must keep, at the corners of the joints' travel, at its ends, with rotary joints at quarter
/// turns (where poles are) and close to them, and at seeded random joint vectors:
/// - the forward of the inverse gives every pose back, to 1e-9 mm and 1e-9 rad;
/// - the inverse, seeded nearby, gives the joints back wherever the Jacobian says that the pose determines them;
/// - the Jacobian is the derivative of the forward, and everywhere the same where that is claimed;
/// - joints are of the type that they are said to be, but those of a parallel machine;
/// - the joint that is said to be left over stays where the seed has it;
/// - two in a hundred joint vectors have a pose at least; the others are passed over;
/// - all solutions are solutions, the nearest first, the one that the pose was made of among them;
/// - a pose that is no number is out of reach.
[[nodiscard]] Checked check_kinematics(const Kinematics& kinematics, const KinematicsCase& given);

}  // namespace rmac::verifier
