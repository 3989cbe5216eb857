#include "servo/laws/joint_laws.hpp"

#include <algorithm>
#include <cmath>

namespace rmac {

JointLaws::JointLaws(std::span<const ServoJoint> joints, double period_s) : joints_(joints) {
  for (const ServoJoint& joint : joints) {
    filters_.emplace_back(joint.mechanics, period_s);
    if (joint.law) joint.law->set_effort_limit(joint.max_effort);
  }
}

double JointLaws::resting_effort(std::size_t joint) const noexcept {
  if (!has_law(joint)) return 0;
  const double wanted = joints_[joint].law->resting_effort();
  const double bound = joints_[joint].max_effort;
  return std::isfinite(wanted) ? std::clamp(wanted, -bound, bound) : 0;
}

void JointLaws::engage(std::size_t joint, const ServoInput& input, double from_effort) noexcept {
  if (!has_law(joint)) return;
  joints_[joint].law->engage(input, from_effort);
  filters_[joint].engage(from_effort);
  pushed_ &= ~only(joint);
}

void JointLaws::engage_beside(std::size_t joint, double from_effort) noexcept {
  if (has_law(joint)) filters_[joint].engage(from_effort);
}

bool JointLaws::run(std::size_t joint, const ServoInput& input, std::optional<double> beside,
                    FaultSink& faults) noexcept {
  if (beside.has_value() != has(pushed_, joint)) {
    engage(joint, input, effort_[joint]);
    pushed_ |= beside ? only(joint) : 0;
  }
  const double wanted = joints_[joint].law->update(input) + beside.value_or(0);
  if (!std::isfinite(wanted)) {
    let_go();
    faults.raise({ServoFault::Kind::NotANumber, ServoFault::Part::Joint, static_cast<std::uint32_t>(joint), wanted, 0});
    return false;
  }
  const double bound = joints_[joint].max_effort;
  effort_[joint] = std::clamp(filters_[joint].update(wanted), -bound, bound);
  return true;
}

}  // namespace rmac
