#include "gateway/rmac_cam/cam_cycle.hpp"

#include <fmt/format.h>

namespace rmac::gateway {

void CamCycle::mechanism_changed(bool fresh) {
  if (fresh) (void)supervisor_.operating().set_override(100, nullptr);  // an operator's 0 stays
}

Expected<> CamCycle::start(sdk::CycleMode mode) {
  return device_.require("CycleStart").and_then([&] {
    return supervisor_.command(
        [mode](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.start(mode, seen); });
  });
}

Expected<> CamCycle::stop() {
  // Before the forces, for which the lock is waited.
  auto stopped = supervisor_.stop_command([](CycleSequencer& cycle, const CycleObservation&) { return cycle.stop(); });
  forces_.let_go();
  return stopped;
}

Expected<> CamCycle::hold(const OperatorRef& who) {
  return supervisor_.stop_command([&who](CycleSequencer& cycle, const CycleObservation&) { return cycle.hold(who); });
}

Expected<> CamCycle::resume(const OperatorRef& who) {
  return supervisor_.command([&who](CycleSequencer& cycle, const CycleObservation& seen) {
    return refuse_when_blocked("FeedResume", seen).and_then([&] { return cycle.resume(who); });
  });
}

Expected<double> CamCycle::retrace(double distance_mm, const OperatorRef& who) {
  return device_.require("FeedRetrace").and_then([&] { return supervisor_.operating().retrace(distance_mm, who); });
}

Expected<> CamCycle::stop_now() {
  auto stopped = supervisor_.stop_command(
      [](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.stop_and_clear(seen); });
  forces_.let_go();
  return stopped;
}

bool CamCycle::started() const {
  const CycleState state = supervisor_.state();
  return state == CycleState::Running || state == CycleState::Holding;
}

Expected<> CamCycle::set_feed_override(double percent, const OperatorRef& who) {
  constexpr double kSlowestPercent = 0.01;
  const bool waits = percent == 0;
  if (!waits && !(percent >= kSlowestPercent && percent <= 200)) {
    return failure(
        MinorCode::InvalidParameterValue,
        fmt::format("SetFeedOverride: {} percent must be 0, which waits, or {} to 200", percent, kSlowestPercent));
  }
  return supervisor_.operating().set_override(percent, who);
}

}  // namespace rmac::gateway
