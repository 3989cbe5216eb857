#pragma once

#include <vector>

#include "gateway/verification/checks/actuator_map_check.hpp"
#include "gateway/verification/checks/kinematics_check.hpp"
#include "gateway/verification/checks/stateless_check.hpp"

namespace rmac::verifier {

/// Seeded calls of every function of a port, within the joints' travel. What they refer to must outlive them.
[[nodiscard]] std::vector<PortCall> calls_of(const Kinematics& kinematics, const KinematicsCase& given);
[[nodiscard]] std::vector<PortCall> calls_of(const ActuatorMap& map, const ActuatorMapCase& given);

}  // namespace rmac::verifier
