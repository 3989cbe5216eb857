#pragma once

#include <array>
#include <string_view>
#include <utility>

#include "rmac/motion/joint.hpp"
#include "rmac/motion/ports/digital_control_interface.hpp"
#include "rmac/sdk/device_object.hpp"

// What enumerators are called in device.json; the schema's `enum` lists the same.

namespace rmac::gateway {

template <typename Enumeration, typename Name, std::size_t kCount>
using Names = std::array<std::pair<Enumeration, Name>, kCount>;

inline constexpr Names<JointType, std::string_view, 3> kJointTypeNames{
    {{JointType::Rotary, "Rotary"}, {JointType::Linear, "Linear"}, {JointType::Screw, "Screw"}}};
inline constexpr Names<JointLimitType, std::string_view, 4> kJointLimitTypeNames{
    {{JointLimitType::Limited, "Limited"},
     {JointLimitType::Infinite, "Infinite"},
     {JointLimitType::InfinitePositive, "InfinitePositive"},
     {JointLimitType::InfiniteNegative, "InfiniteNegative"}}};
inline constexpr Names<ControlMethod, std::string_view, 3> kControlMethodNames{
    {{ControlMethod::Position, "Position"}, {ControlMethod::Velocity, "Velocity"}, {ControlMethod::Force, "Force"}}};
inline constexpr Names<TouchProbeEdge, int, 4> kTouchProbeNumbers{{{TouchProbeEdge::FirstRising, 1},
                                                                   {TouchProbeEdge::FirstFalling, -1},
                                                                   {TouchProbeEdge::SecondRising, 2},
                                                                   {TouchProbeEdge::SecondFalling, -2}}};
inline constexpr Names<sdk::ToolChangeStep::Kind, std::string_view, 4> kToolChangeNames{
    {{sdk::ToolChangeStep::Kind::MoveTo, "MoveTo"},
     {sdk::ToolChangeStep::Kind::Switch, "Switch"},
     {sdk::ToolChangeStep::Kind::Select, "Select"},
     {sdk::ToolChangeStep::Kind::Await, "Await"}}};

/// The enumerator of a name that the schema has passed.
template <typename Enumeration, typename Name, std::size_t kCount>
[[nodiscard]] Enumeration named(const Name& name, const Names<Enumeration, Name, kCount>& names) {
  for (const auto& [enumerator, its_name] : names) {
    if (its_name == name) return enumerator;
  }
  return names.front().first;
}

template <typename Enumeration, typename Name, std::size_t kCount>
[[nodiscard]] Name name_of(Enumeration enumerator, const Names<Enumeration, Name, kCount>& names) {
  for (const auto& [known, name] : names) {
    if (known == enumerator) return name;
  }
  return names.front().second;
}

}  // namespace rmac::gateway
