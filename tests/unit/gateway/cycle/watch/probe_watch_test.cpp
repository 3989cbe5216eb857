#include "gateway/cycle/watch/probe_watch.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

ProbeReport hit(std::uint32_t hits) {
  return {.ready = true, .touching = true, .hits = hits};
}

TEST(ProbeWatch, StopsAtAHitThatNobodyAskedFor) {
  ProbeWatch watch;
  const auto verdict = watch.step({.moves_left = 1, .at_rest = false, .probe = hit(1)});
  EXPECT_EQ(verdict.stop, StopCause::UnexpectedHit);
  EXPECT_FALSE(verdict.touched);
}

TEST(ProbeWatch, EndsAJogAtAHitByHandAndEmptiesAQueue) {
  for (const bool jogs : {true, false}) {
    ProbeWatch watch;
    watch.measurement().expect_by_hand(true);
    const auto verdict = watch.step({.moves_left = 1, .at_rest = false, .probe = hit(1), .positions = jogs});
    EXPECT_EQ(verdict.touched, jogs);
    EXPECT_EQ(verdict.stop, jogs ? std::nullopt : std::optional(StopCause::HitByHand));
  }
}

TEST(ProbeWatch, EndsASearchAtItsHitAndSaysWhyItEndedWithoutOne) {
  const auto end_of_search = [](const ProbeWatch::Seen& seen) {
    ProbeWatch watch;
    watch.measurement().begin(1);
    (void)watch.step({.moves_left = 1, .at_rest = false, .probe = {.ready = true}});
    return watch.step(seen);
  };
  EXPECT_TRUE(end_of_search({.moves_left = 1, .at_rest = false, .probe = hit(1)}).touched);
  EXPECT_EQ(end_of_search({.moves_left = 0, .at_rest = true, .probe = {.ready = true}}).stop, StopCause::PartNotFound);
  EXPECT_EQ(end_of_search({.moves_left = 1, .at_rest = false, .probe = {.ready = false}}).stop, StopCause::ProbeLost);
  EXPECT_EQ(end_of_search({.moves_left = 1, .at_rest = false, .probe = hit(0)}).stop, StopCause::ProbeDeflected);
}

TEST(ProbeWatch, SaysThatTheProbeIsStuckAfterTheWayBack) {
  ProbeWatch watch;
  watch.measurement().retract();
  EXPECT_EQ(watch.step({.moves_left = 0, .at_rest = true, .probe = hit(0)}).stop, StopCause::ProbeStuck);
}

TEST(ProbeWatch, MeasuresNothingAnyMoreOnceItIsGivenUp) {
  ProbeWatch watch;
  watch.measurement().begin(1);
  const auto verdict = watch.step({.moves_left = 0, .at_rest = true, .probe = {.ready = true}, .given_up = true});
  EXPECT_EQ(verdict.stop, std::nullopt) << "no part was looked for any more";
  EXPECT_FALSE(watch.measurement().pending());
}

TEST(ProbeWatch, SimulatesAProbeInVirtualModeAlone) {
  ProbeWatch watch;
  watch.install(true, {});
  watch.measurement().begin(1);
  (void)watch.step({.moves_left = 1, .at_rest = false});
  watch.simulate(true);
  EXPECT_TRUE(watch.step({.moves_left = 1, .at_rest = false}).touched);
  watch.install(false, {});
  watch.simulate(false);
  watch.simulate(true);
  EXPECT_EQ(watch.step({.moves_left = 1, .at_rest = false}).stop, std::nullopt) << "the real probe tells nothing";
}

TEST(ProbeWatch, CountsOnFromAnotherMechanismsProbe) {
  ProbeWatch watch;
  watch.measurement().begin(1);
  watch.install(false, hit(41));
  EXPECT_FALSE(watch.measurement().pending());
  EXPECT_EQ(watch.step({.moves_left = 1, .at_rest = false, .probe = hit(41)}).stop, std::nullopt);
  EXPECT_EQ(watch.step({.moves_left = 1, .at_rest = false, .probe = hit(42)}).stop, StopCause::UnexpectedHit);
}

}  // namespace
}  // namespace rmac::gateway
