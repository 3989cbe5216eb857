#pragma once

#include "gateway/verification/checks/check.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"

namespace rmac::verifier {

/// An inverse says of a pose that it cannot be reached, or gives the joints of that very pose; never those of a pose
/// nearby. Asked for poses of joints up to a tenth of their travel beyond its ends, and, on seeded ways that lead the
/// tool away from where it can be and tilt it, on either side of wherever the reach ends.
[[nodiscard]] Checked check_reach(const Kinematics& kinematics, const KinematicsCase& given);

}  // namespace rmac::verifier
