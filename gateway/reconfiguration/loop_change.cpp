#include "gateway/reconfiguration/loop_change.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gateway/mechanism/device_check.hpp"

namespace rmac::gateway {
namespace {

bool other_law(const sdk::Joint& now, const sdk::Joint& wanted) {
  return now.servo_law != wanted.servo_law || now.gains != wanted.gains;
}

/// Only a joint that goes back to position control is refused.
std::string slipped_text(const sdk::DeviceObject& device, const std::vector<SwapRequest::Method>& methods) {
  std::vector<std::string> names;
  for (const SwapRequest::Method& other : methods) {
    if (other.method == ControlMethod::Position) names.push_back(joint_at(device, other.joint).limits.name);
  }
  return fmt::format("{} {} has slipped off the plan; change it with the machine at rest",
                     names.size() == 1 ? "joint" : "one of the joints", fmt::join(names, ", "));
}

}  // namespace

std::vector<std::size_t> LoopChange::joints(const sdk::DeviceObject& device) const {
  const sdk::DeviceObject& in_force = slot_.in_force()->device;
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < in_force.joint_count_with_held(); ++j) {
    const sdk::Joint &now = joint_at(in_force, j), &wanted = joint_at(device, j);
    if (other_law(now, wanted) || now.method != wanted.method) joints.push_back(j);
  }
  return joints;
}

bool LoopChange::changes_method(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints) const {
  return std::ranges::any_of(joints, [&](std::size_t j) {
    return joint_at(slot_.in_force()->device, j).method != joint_at(device, j).method;
  });
}

Expected<> LoopChange::check(const sdk::DeviceObject& device) {
  return slot_.require_sound("other servo loops").and_then([&] { return check_device(device); });
}

Expected<> LoopChange::exchange(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints) {
  auto loops = load(device, joints);
  if (!loops) return tl::unexpected(loops.error());
  if (auto exchanged = hand_over(device, *loops); !exchanged) return exchanged;
  note(device, joints, *loops);
  const sdk::DeviceObject& now = slot_.in_force()->device;
  users_.draft_from(&now);
  slot_.report(fmt::format("{} is configured: servo loop of joint {}", now.name, fmt::join(loops->names, ", ")));
  return {};
}

Expected<LoopChange::Loops> LoopChange::load(const sdk::DeviceObject& device,
                                             const std::vector<std::size_t>& joints) const {
  const Mechanism& in_force = *slot_.in_force();
  Loops loops;
  for (const std::size_t j : joints) {
    const sdk::Joint &now = joint_at(in_force.device, j), &wanted = joint_at(device, j);
    loops.names.push_back(wanted.limits.name);
    if (now.method != wanted.method) loops.methods.push_back({j, wanted.method});
    if (!other_law(now, wanted)) continue;
    auto law = load_joint_law(wanted, assembler_.loader(slot_.folder()), loops.modules);
    if (!law) return tl::unexpected(law.error());
    (*law)->set_effort_limit(wanted.max_effort);
    // The assembler made it.
    auto* const place = static_cast<ExchangeableLaw*>(in_force.loop->parts().joints[j].law.get());
    loops.laws.push_back({place, std::move(*law)});
  }
  return loops;
}

Expected<> LoopChange::hand_over(const sdk::DeviceObject& device, Loops& loops) {
  SwapRequest request;
  request.laws = loops.laws;
  request.methods = loops.methods;
  if (auto asked = servo_.ask(request); !asked) return asked;
  if (request.result == SwapRequest::Result::Done) return {};
  return failure(MinorCode::Other, slipped_text(device, loops.methods));
}

void LoopChange::note(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints, const Loops& loops) {
  Mechanism& in_force = *slot_.in_force();
  for (const std::size_t j : joints) {
    const sdk::Joint& wanted = joint_at(device, j);
    sdk::Joint& now = joint_at(in_force.device, j);
    now.servo_law = wanted.servo_law;
    now.gains = wanted.gains;
    now.method = wanted.method;
  }
  for (const ModuleInUse& used : loops.modules) {
    const auto same_role = [&](const ModuleInUse& before) { return before.role == used.role; };
    std::replace_if(in_force.modules.begin(), in_force.modules.end(), same_role, used);
  }
}

}  // namespace rmac::gateway
