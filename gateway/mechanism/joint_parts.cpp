#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "gateway/mechanism/assembler.hpp"
#include "gateway/mechanism/exchangeable_law.hpp"
#include "gateway/mechanism/loop_draft.hpp"
#include "rmac/sdk/servo_law_names.hpp"

namespace rmac::gateway {
namespace {

/// What is not declared follows from the joint's speed. A word of a drive that comes a cycle late makes one step of its
/// position up to twice that speed short or long; a jump is what that cannot explain.
JointBounds bounds(const sdk::Joint& joint, double period_s) {
  constexpr double kSpeedShare = 1.2, kJumpCycles = 3;
  const double speed = joint.limits.max_speed;
  const double no_end = std::numeric_limits<double>::infinity();
  return {.velocity = joint.max_measured_speed > 0 ? joint.max_measured_speed : kSpeedShare * speed,
          .jump = joint.max_jump > 0 ? joint.max_jump : kJumpCycles * speed * period_s,
          .stop_deceleration = joint.limits.max_acceleration,
          .stop_jerk = joint.limits.max_jerk,
          .min_position = ends_below(joint.limits) ? joint.limits.min : -no_end,
          .max_position = ends_above(joint.limits) ? joint.limits.max : no_end};
}

ForceControl force(const sdk::Joint& joint) {
  ForceControl result = joint.force.value_or(ForceControl{});
  result.max_acceleration = joint.limits.max_acceleration;
  // A law with a model of the joint knows what it weighs.
  const auto known = joint.servo_law.numbers.find("mass");
  if (result.mass == 0 && known != joint.servo_law.numbers.end() && known->second.size() == 1)
    result.mass = known->second.front();
  return result;
}

Expected<ServoJoint> make_joint(const sdk::Joint& joint, LoopDraft& draft) {
  ServoJoint made{nullptr,          joint.method,    joint.max_following_error,
                  joint.max_effort, joint.mechanics, bounds(joint, draft.parts.period_s),
                  std::nullopt,     force(joint),    joint.gantry};
  if (joint.servo_law.name.empty()) return made;
  auto law = load_joint_law(joint, draft.loader, draft.modules);
  if (!law) return tl::unexpected(law.error());
  made.law = std::make_shared<ExchangeableLaw>(std::move(*law));
  return made;
}

}  // namespace

Expected<std::shared_ptr<ServoLaw>> load_law(const sdk::ModuleChoice& choice, const std::vector<double>& gains,
                                             const std::string& who, const ModuleLoader& loader,
                                             std::vector<ModuleInUse>& modules) {
  const std::string name = sdk::servo_law_module(choice.name);
  auto law = loader.load<ServoLaw>({name, choice.numbers, choice.texts});
  if (!law) return tl::unexpected(law.error());
  if (!law->object->set_gains(gains)) {
    std::string wanted;
    for (const GainInfo& gain : law->object->gains()) {
      wanted += fmt::format("{}{} ({})", wanted.empty() ? "" : ", ", gain.name, gain.unit);
    }
    return failure(MinorCode::InvalidParameterValue,
                   fmt::format("{}: {} does not accept the gains [{}]; it takes {}: {}", who, name,
                               fmt::join(gains, ", "), law->object->gains().size(), wanted));
  }
  modules.push_back({"servo control law of " + who, name, law->build_id});
  return std::move(law->object);
}

Expected<> add_joints(LoopDraft& draft) {
  for (std::size_t j = 0; j < draft.device.joint_count_with_held(); ++j) {
    const sdk::Joint& joint = joint_at(draft.device, j);
    auto made = make_joint(joint, draft);
    if (!made) return tl::unexpected(made.error());
    draft.parts.joints.push_back(std::move(*made));
    draft.parts.virtual_start.push_back(
        joint.limits.limit_type == JointLimitType::Limited ? std::clamp(0.0, joint.limits.min, joint.limits.max) : 0.0);
  }
  return {};
}

}  // namespace rmac::gateway
