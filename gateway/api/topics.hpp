#pragma once

#include <array>

/// What `subscribe` knows.
namespace rmac::gateway::topic {

inline constexpr const char* kState = "state";
inline constexpr const char* kJoints = "joints";
inline constexpr const char* kDrives = "drives";
inline constexpr const char* kAnimation = "animation";
inline constexpr const char* kEvents = "events";
inline constexpr std::array kAll{kState, kJoints, kDrives, kAnimation, kEvents};

}  // namespace rmac::gateway::topic
