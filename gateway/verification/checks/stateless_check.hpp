#pragma once

#include "gateway/verification/checks/kinematics_check.hpp"

namespace rmac::verifier {

/// What kinematics must keep because the planner and the servo thread call the same object at the same time, as often
/// as they like: the same call has the same answer, to the last bit,
/// - after millions of other calls, as far as they fit into some seconds of CPU time;
/// - while another thread makes calls of its own.
/// The forward and the inverse are asked at seeded random joint vectors.
[[nodiscard]] Checked check_stateless(const Kinematics& kinematics, const KinematicsCase& given);

}  // namespace rmac::verifier
