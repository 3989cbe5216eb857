// Other servo laws, gains or control methods for joints of the mechanism in force, and nothing else: the servo thread
// exchanges them between two cycles, in motion too, and all that is planned goes on.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "gateway/controller/controller_impl.hpp"

namespace rmac::gateway {

namespace {

/// Joints count first, held joints follow.
auto& joint_of(auto& device, std::size_t number) {
  const std::size_t moved = device.joints.size();
  return number < moved ? device.joints[number] : device.held_joints[number - moved];
}

/// Only a joint that goes back to position control is refused.
std::string slipped_text(const sdk::DeviceObject& device, const std::vector<SwapRequest::Method>& methods) {
  std::vector<std::string> names;
  for (const SwapRequest::Method& other : methods) {
    if (other.method == ControlMethod::Position) names.push_back(joint_of(device, other.joint).limits.name);
  }
  return fmt::format("{} {} has slipped off the plan; change it with the machine at rest",
                     names.size() == 1 ? "joint" : "one of the joints", fmt::join(names, ", "));
}

}  // namespace

bool Controller::Impl::other_law(const sdk::Joint& now, const sdk::Joint& wanted) {
  return !same_choice(now.servo_law, wanted.servo_law) || now.gains != wanted.gains;
}

std::vector<std::size_t> Controller::Impl::joints_with_other_loops(const sdk::DeviceObject& device) const {
  std::vector<std::size_t> joints;
  for (std::size_t j = 0; j < in_force->loop->joint_count_with_held(); ++j) {
    const sdk::Joint &now = joint_of(in_force->device, j), &wanted = joint_of(device, j);
    if (other_law(now, wanted) || now.method != wanted.method) joints.push_back(j);
  }
  return joints;
}

Expected<> Controller::Impl::change_loops(const sdk::DeviceObject& device, const std::vector<std::size_t>& joints) {
  if (auto ready = fit_for_change("other servo loops").and_then([&] { return check_device(device); }); !ready) {
    return ready;
  }
  const auto other_method = [&](std::size_t j) {
    return joint_of(in_force->device, j).method != joint_of(device, j).method;
  };
  // At rest a joint that has slipped takes its place along.
  if (std::ranges::any_of(joints, other_method) && supervisor.require_rest("another control method")) {
    return put_in(device, false);
  }
  std::vector<SwapRequest::Law> laws;
  std::vector<SwapRequest::Method> methods;
  std::vector<ModuleInUse> modules;
  std::vector<std::string> names;
  for (const std::size_t j : joints) {
    const sdk::Joint& joint = joint_of(device, j);
    names.push_back(joint.limits.name);
    if (other_method(j)) methods.push_back({j, joint.method});
    if (!other_law(joint_of(in_force->device, j), joint)) continue;
    auto law = load_joint_law(joint, loader(folder_in_force), modules);
    if (!law) return tl::unexpected(law.error());
    (*law)->set_effort_limit(joint.max_effort);
    // The assembler made it.
    auto* const now = static_cast<ExchangeableLaw*>(in_force->loop->parts().joints[j].law.get());
    laws.push_back({now, std::move(*law)});
  }
  SwapRequest request;
  request.laws = laws;
  request.methods = methods;
  if (auto exchanged = ask_servo_thread(request); !exchanged) {
    if (request.result != SwapRequest::Result::Refused) return exchanged;
    return failure(MinorCode::Other, slipped_text(device, methods));
  }
  for (const std::size_t j : joints) {
    sdk::Joint& now = joint_of(in_force->device, j);
    now.servo_law = joint_of(device, j).servo_law;
    now.gains = joint_of(device, j).gains;
    now.method = joint_of(device, j).method;
  }
  for (const ModuleInUse& used : modules) {
    const auto same_role = [&](const ModuleInUse& before) { return before.role == used.role; };
    std::replace_if(in_force->modules.begin(), in_force->modules.end(), same_role, used);
  }
  draft.discard(&in_force->device);
  tell_of_mechanism(
      fmt::format("{} is configured: servo loop of joint {}", in_force->device.name, fmt::join(names, ", ")));
  return {};
}

}  // namespace rmac::gateway
