#include "gateway/cycle/watch/path_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::gateway {
namespace {

constexpr double kStandsAtMost_s = 0.5;
/// No more than this of the time between two looks counts: a planner that was not let run cannot have planned.
constexpr double kLook_s = 0.01;
/// Along the path; a thousandth of what the slowest feed goes in the time that counts.
constexpr double kProgress_mm = 1e-7;

/// Nothing where a stop was asked for: then it is no fault.
std::optional<std::string> describe(const PathDeparture& departure) {
  const char* what = nullptr;
  switch (departure.cause) {
    case PathDeparture::Cause::Stop:
      return std::nullopt;
    case PathDeparture::Cause::NoSolution:
      what = "found no joints for a pose of the path that they had when it was planned";
      break;
    case PathDeparture::Cause::NotANumber:
      what = "gave something that is no number";
      break;
    case PathDeparture::Cause::Jump:
      what = "gave a place that the joint could not have come to within a cycle";
      break;
  }
  const std::string joint =
      departure.cause == PathDeparture::Cause::NoSolution ? "" : fmt::format(" for joint {}", departure.joint);
  return fmt::format(
      "cycle {}: the kinematics {}{}, so every joint was stopped by itself, within its limits; have their module "
      "mended (rmac verify), then reset",
      departure.cycle + 1, what, joint);
}

}  // namespace

bool PathWatch::stands(const Seen& seen) noexcept {
  const double passed_s = std::clamp(seen.t_s - looked_at_s_, 0.0, kLook_s);
  looked_at_s_ = seen.t_s;
  if (seen.should_move && seen.move_id == move_id_ && std::abs(seen.s_mm - s_mm_) < kProgress_mm) {
    stood_s_ += passed_s;
    return stood_s_ > kStandsAtMost_s;
  }
  move_id_ = seen.move_id;
  s_mm_ = seen.s_mm;
  stood_s_ = 0;
  return false;
}

std::optional<std::string> PathWatch::step(const Seen& seen) {
  if (seen.departure.count != departures_) {
    departures_ = seen.departure.count;
    if (auto wrong = describe(seen.departure)) return wrong;
  }
  if (!stands(seen)) return std::nullopt;
  stood_s_ = 0;
  return fmt::format(
      "the machine has stood for {} s at move {}, {:.6f} mm into it, though the cycle runs and nothing is waited for: "
      "the planner finds no way on within the joints' limits; look at the kinematics and the limits there, then reset",
      kStandsAtMost_s, seen.move_id, seen.s_mm);
}

}  // namespace rmac::gateway
