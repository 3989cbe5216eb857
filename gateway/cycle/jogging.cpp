#include "gateway/cycle/jogging.hpp"

#include <utility>

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
      .and_then([&] { return entry_.build(move); })
      .and_then([&](std::vector<BuiltMove> built) { return start(std::move(built), share); });
}

Expected<> Jogging::start(std::vector<BuiltMove> built, std::optional<double> share) {
  const GatewayTurn turn(cycle_.lock);
  cycle_.notice_fault();
  const CycleObservation seen = cycle_.observe(cycle_.status());
  if (auto fits = cycle_.sequencer.check_positioning(seen); !fits) {
    cycle_.queue.begin_anew();  // what was built behind it is not queued
    return fits;
  }
  // Before the move is queued: the cycle would run it as one of its own.
  cycle_.sequencer.end_waiting(seen);
  cycle_.settle(cycle_.status());
  const auto moving = cycle_.add(std::move(built));
  if (!moving) return tl::unexpected(moving.error());
  if (*moving == 0) return {};
  cycle_.feed.jog_at(share.value_or(1));
  cycle_.apply_feed();
  auto started = cycle_.sequencer.start_positioning(cycle_.observe(cycle_.status()),
                                                    share ? std::optional(kJogLasts_s) : std::nullopt);
  if (!started) cycle_.empty_queue(cycle_.status());  // its move is no program's
  cycle_.settle(cycle_.status());
  return started;
}

bool Jogging::renew(double share) {
  const GatewayTurn turn(cycle_.lock);
  const ServoStatus now = cycle_.status();
  cycle_.settle(now);  // it may have ended since
  if (!cycle_.sequencer.phase().jogs()) return false;
  cycle_.sequencer.renew_jog(cycle_.observe(now), kJogLasts_s);
  cycle_.settle(now);  // the servo thread knows its end too
  cycle_.feed.jog_at(share);
  cycle_.apply_feed();
  return true;
}

Expected<> Jogging::end() {
  // A program that runs is not to be touched.
  if (!cycle_.jogs()) return {};
  return cycle_.stop_command([](CycleSequencer& cycle, const CycleObservation&) {
    return cycle.phase().jogs() ? cycle.stop() : Expected<>{};
  });
}

}  // namespace rmac::gateway
