#include "gateway/rmac/program/timing.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include "gateway/api/methods/method_table.hpp"
#include "gateway/rmac/wire/requests.hpp"

namespace rmac::cli {

namespace {

using namespace std::string_view_literals;

constexpr std::array kCycleStarts{std::string_view(kStartCycle), "RMAC_CAM.SetCycleStartStatus"sv};

// The table says that these do nothing to motion, not that they hold for the moves queued after them, so that the moves
// under way need not end first.
constexpr std::array kModal{"RMAC_CAM.SetFeedrate"sv,
                            "RMAC_CAM.SetPathTolerance"sv,
                            "RMAC_CAM.SetPathAccelRise"sv,
                            "RMAC_CAM.SetPathAccelFall"sv,
                            "RMAC_CAM.SetFeedOverride"sv,
                            "RMAC_CAM.SetJointInterpSpeed"sv,
                            "RMAC_CAM.SetOrientationTolerance"sv};

// Questions about what the moves before them did: they are asked when these are done.
constexpr std::array kAsksOfMoves{"RMAC_CAM.LastHitPosition"sv, "RMAC_CAM.NewHit"sv, "RMAC_CAM.ProbeActive"sv,
                                  "FlightRecorder.Record"sv};

// Questions that change the probing with `newVal`.
constexpr std::array kProbing{"RMAC_CAM.ControlMode"sv, "RMAC_CAM.Parameter"sv};

constexpr std::array kBetweenMoves{"RMAC_CAM.DoToolChange"sv, "RMAC_CAM.Dwell"sv, "RMAC_CAM.ProgramStop"sv,
                                   "RMAC_CAM.AwaitInput"sv, "RMAC_CAM.InTurn"sv};

bool is_one_of(const std::string& method, const auto& names) {
  return std::ranges::find(names, method) != names.end();
}

}  // namespace

Timing timing_of(const std::string& method) {
  const gateway::Method* found = gateway::find_method(method);
  if (found == nullptr) return Timing::Settled;
  if (found->effect == gateway::Effect::Queues) return Timing::Move;
  if (is_one_of(method, kCycleStarts)) return Timing::Start;
  if (found->effect != gateway::Effect::None) return Timing::Settled;
  const bool asks = found->permission == gateway::Permission::Anyone && !is_one_of(method, kAsksOfMoves) &&
                    !is_one_of(method, kProbing);
  return asks || is_one_of(method, kModal) ? Timing::Stream : Timing::Settled;
}

bool stands_between_moves(const std::string& method) {
  return is_one_of(method, kBetweenMoves);
}

bool measures(const std::string& method) {
  return method == kMeasurePoint;
}

}  // namespace rmac::cli
