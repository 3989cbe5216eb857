#pragma once

#include <vector>

#include "gateway/verification/checks/check.hpp"
#include "rmac/motion/ports/actuator_map.hpp"

namespace rmac::verifier {

/// One joint of a map under check. Joint power is effort · speed · `power_scale` watts: 1e-3 for mm and N, π/180 for
/// degrees and N·m.
struct MappedJoint {
  double min = 0, max = 0, power_scale = 1e-3;
};

struct ActuatorMapCase {
  std::vector<MappedJoint> joints;
  std::size_t actuators = 0;  ///< 0: any
  int samples = 100'000;
  std::uint64_t seed = 1;
  Misdeed misdeed{};
};

/// What every actuator map must keep, over seeded random joints within their travel: positions go there and back, shaft
/// velocities belong to the positions (by finite differences), efforts are linear, every joint's effort reaches a
/// shaft, and the power at the shafts is the power at the joints.
[[nodiscard]] Checked check_actuator_map(const ActuatorMap& map, const ActuatorMapCase& given);

}  // namespace rmac::verifier
