#include "gateway/cycle/jogging.hpp"

namespace rmac::gateway {
namespace {

/// A jog by velocity stops when it was not renewed for so long (the design's dead-man).
constexpr double kJogLasts_s = 0.2;

}  // namespace

Expected<> Jogging::begin() {
  auto fits = cycle_.command(
      [](const CycleSequencer& cycle, const CycleObservation& seen) { return cycle.check_positioning(seen); });
  if (!fits) return fits;
  const GatewayTurn turn(cycle_.lock);
  auto rest = cycle_.require_rest("a jog");
  if (rest) cycle_.queue.begin_anew();
  return rest;
}

Expected<> Jogging::run(const Move& move, std::optional<double> share) {
  return begin()
      .and_then([&] { return entry_.prepare(); })
      .and_then([&] { return entry_.add(move); })
      .and_then([&](bool moves) { return moves ? start(share) : Expected<>{}; });
}

Expected<> Jogging::start(std::optional<double> share) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  cycle_.feed.jog_at(share.value_or(1));
  cycle_.apply_feed();
  auto started = cycle_.sequencer.start_positioning(cycle_.observe(cycle_.status()),
                                                    share ? std::optional(kJogLasts_s) : std::nullopt);
  if (!started) cycle_.empty_queue(cycle_.status().progress.cycle);  // its move is no program's
  cycle_.settle(cycle_.status());
  return started;
}

bool Jogging::renew(double share) {
  const GatewayTurn turn(cycle_.lock);
  const ServoStatus now = cycle_.status();
  cycle_.settle(now);  // it may have ended since
  if (!cycle_.sequencer.jogs()) return false;
  cycle_.sequencer.renew_jog(cycle_.observe(now), kJogLasts_s);
  cycle_.settle(now);  // the servo thread knows its end too
  cycle_.feed.jog_at(share);
  cycle_.apply_feed();
  return true;
}

Expected<> Jogging::end() {
  // A program that runs is not to be touched.
  if (!cycle_.jogs()) return {};
  return cycle_.stop_command(
      [](CycleSequencer& cycle, const CycleObservation&) { return cycle.jogs() ? cycle.stop() : Expected<>{}; });
}

}  // namespace rmac::gateway
