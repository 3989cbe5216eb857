#pragma once

#include <optional>
#include <string>

#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"
#include "gateway/rmac/wire/notes.hpp"
#include "rmac/sdk/rmac_cam.hpp"

// Requests that several commands make.

namespace rmac::cli {

inline constexpr const char* kLoadMachine = "Device.Load";
inline constexpr const char* kStartCycle = "RMAC_CAM.CycleStart";
inline constexpr const char* kJogJoint = "RMAC_CAM.JogJoint";
inline constexpr const char* kMoveToPoint = "RMAC_CAM.MoveToXYZ";
inline constexpr const char* kMeasurePoint = "RMAC_CAM.AutoMeasure";
inline constexpr const char* kHoldFeed = "RMAC_CAM.FeedHold";
inline constexpr const char* kSetOverride = "RMAC_CAM.SetFeedOverride";
inline constexpr const char* kResumeFeed = "RMAC_CAM.FeedResume";
inline constexpr const char* kConfirmToolChange = "RMAC_CAM.ConfirmToolChange";
inline constexpr const char* kSetLearnedOffsets = "RMAC_CAM.SetLearnedOffsets";
inline constexpr const char* kGetParkedProgram = "RMAC_CAM.GetParkedProgram";

/// The wire's name of a mode.
[[nodiscard]] const char* name_of(sdk::CycleMode mode);

/// Has a topic pushed to this connection; without a rate, at the appliance's own.
[[nodiscard]] Result<> subscribe(Connection& connection, const char* topic, std::optional<double> rate_hz = {});
[[nodiscard]] Result<StateNote> ask_state(Connection& connection);
/// Starts the cycle that runs what is queued and what comes after it. Needs motion authority.
[[nodiscard]] Result<> start_cycle(Connection& connection);
/// Stops as fast as the limits allow, and empties the queue.
[[nodiscard]] Result<> stop_now(Connection& connection);
/// Loads a machine. Needs motion authority.
[[nodiscard]] Result<> load_machine(Connection& connection, const std::string& name, bool virtual_mode,
                                    double soften = 1);
/// Name of the machine that is loaded; an error where none is.
[[nodiscard]] Result<std::string> loaded_machine(Connection& connection);

}  // namespace rmac::cli
