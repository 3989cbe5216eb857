#include "gateway/verification/checks/port_calls.hpp"

#include <algorithm>
#include <random>

#include "gateway/verification/checks/pose_bounds.hpp"

namespace rmac::verifier {
namespace {

constexpr std::size_t kCalls = 500;  ///< of each function

using Joints = std::vector<double>;

void answer_pose(const ToolPose& pose, std::span<double> answer) {
  std::copy(pose.tip.begin(), pose.tip.end(), answer.begin());
  std::copy(pose.axis.begin(), pose.axis.end(), answer.begin() + 3);
}

}  // namespace

std::vector<PortCall> calls_of(const Kinematics& kinematics, const KinematicsCase& given) {
  std::mt19937_64 random(given.seed + 1);
  const std::size_t n = given.ranges.size();
  std::vector<PortCall> calls;
  for (std::size_t i = 0; i < kCalls; ++i) {
    constexpr double kNearby = 1e-3;
    const Frame tool = given.tools[i % given.tools.size()];
    Joints joints, seed;
    do {
      joints.clear();
      for (const JointRange& range : given.ranges) {
        joints.push_back(std::uniform_real_distribution<>(range.min, range.max)(random));
      }
    } while (!kinematics.has_pose(joints));
    for (const double joint : joints) {
      seed.push_back(joint + std::uniform_real_distribution<>(-kNearby, kNearby)(random));
    }
    ToolPose pose;
    kinematics.forward(joints, tool, pose);
    const std::vector<NamedNumbers> of_joints{named("joints", joints), named_tool(tool)};
    const std::vector<NamedNumbers> of_pose{named_pose("pose", pose), named_tool(tool), named("seed", seed)};
    calls.push_back({"forward", of_joints, 6, [&kinematics, joints, tool](std::span<double> answer) {
                       ToolPose result;
                       kinematics.forward(joints, tool, result);
                       answer_pose(result, answer);
                     }});
    calls.push_back({"jacobian", of_joints, 6 * n, [&kinematics, joints, tool](std::span<double> answer) {
                       kinematics.jacobian(joints, tool, answer);
                     }});
    calls.push_back({"has_pose", {named("joints", joints)}, 1, [&kinematics, joints](std::span<double> answer) {
                       answer[0] = kinematics.has_pose(joints) ? 1 : 0;
                     }});
    calls.push_back({"inverse", of_pose, n, [&kinematics, pose, tool, seed](std::span<double> answer) {
                       // Joints without a solution say nothing.
                       if (kinematics.inverse(pose, tool, seed, answer) != KinematicsStatus::Ok) {
                         std::fill(answer.begin(), answer.end(), 0.0);
                       }
                     }});
    calls.push_back(
        {"solutions", of_pose, 1 + kMostSolutions * n, [&kinematics, pose, tool, seed, n](std::span<double> answer) {
           const std::size_t count = kinematics.solutions(pose, tool, seed, answer.subspan(1));
           answer[0] = static_cast<double>(count);
           const std::size_t used = 1 + std::min(count, kMostSolutions) * n;
           std::fill(answer.begin() + static_cast<std::ptrdiff_t>(used), answer.end(), 0.0);
         }});
  }
  calls.push_back({"pole", {}, 4, [&kinematics](std::span<double> answer) {
                     Vector axis{};
                     answer[0] = kinematics.pole(axis) ? 1 : 0;
                     std::copy(axis.begin(), axis.end(), answer.begin() + 1);
                   }});
  return calls;
}

std::vector<PortCall> calls_of(const ActuatorMap& map, const ActuatorMapCase& given) {
  std::mt19937_64 random(given.seed + 1);
  const std::size_t n = given.joints.size(), shafts_count = map.actuator_count();
  std::vector<PortCall> calls;
  for (std::size_t i = 0; i < kCalls; ++i) {
    constexpr double kMost = 100;
    const auto numbers = [&](std::size_t count) {
      Joints result(count);
      for (double& number : result) number = std::uniform_real_distribution<>(-kMost, kMost)(random);
      return result;
    };
    Joints joints, shafts(shafts_count);
    for (const MappedJoint& joint : given.joints) {
      joints.push_back(std::uniform_real_distribution<>(joint.min, joint.max)(random));
    }
    map.actuator_positions(joints, shafts);
    const Joints efforts = numbers(n), rates = numbers(shafts_count);
    calls.push_back(
        {"actuator_positions", {named("joints", joints)}, shafts_count, [&map, joints](std::span<double> answer) {
           map.actuator_positions(joints, answer);
         }});
    calls.push_back({"joint_positions", {named("actuators", shafts)}, n, [&map, shafts](std::span<double> answer) {
                       map.joint_positions(shafts, answer);
                     }});
    calls.push_back({"joint_velocities",
                     {named("actuators", shafts), named("velocities", rates)},
                     n,
                     [&map, shafts, rates](std::span<double> answer) { map.joint_velocities(shafts, rates, answer); }});
    calls.push_back(
        {"actuator_efforts",
         {named("joints", joints), named("efforts", efforts)},
         shafts_count,
         [&map, joints, efforts](std::span<double> answer) { map.actuator_efforts(joints, efforts, answer); }});
  }
  return calls;
}

}  // namespace rmac::verifier
