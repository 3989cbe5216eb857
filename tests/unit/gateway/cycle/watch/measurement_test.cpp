#include "gateway/cycle/watch/measurement.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

using Verdict = Measurement::Verdict;

class Touch : public testing::Test {
 protected:
  Verdict see(std::size_t moves_left, bool at_rest) { return measurement_.step({moves_left, at_rest, probe_}); }
  void touch() {
    ++probe_.hits;
    probe_.touching = true;
  }
  /// The search is under way.
  void search() {
    measurement_.begin(2);
    EXPECT_EQ(see(2, false), Verdict::Nothing);
    EXPECT_EQ(measurement_.phase(), Measurement::Phase::Approach);
    EXPECT_EQ(see(1, false), Verdict::Nothing);
    EXPECT_EQ(measurement_.phase(), Measurement::Phase::Search);
    EXPECT_EQ(measurement_.steps(), 1U) << "the approach is done";
  }
  Measurement measurement_;
  ProbeReport probe_{.ready = true};
};

TEST_F(Touch, IsFoundRetractedFromAndDone) {
  search();
  touch();
  EXPECT_EQ(see(1, false), Verdict::Touched);
  EXPECT_EQ(see(1, false), Verdict::Nothing) << "the hit counts once";
  EXPECT_EQ(measurement_.phase(), Measurement::Phase::Touched);
  EXPECT_EQ(see(0, true), Verdict::Nothing);
  EXPECT_EQ(measurement_.phase(), Measurement::Phase::Standing);
  measurement_.retract();
  EXPECT_EQ(see(1, false), Verdict::Nothing);
  probe_.touching = false;
  EXPECT_EQ(see(0, true), Verdict::Done);
  EXPECT_FALSE(measurement_.pending());
}

TEST_F(Touch, ThatDoesNotComeEndsTheSearch) {
  search();
  EXPECT_EQ(see(0, true), Verdict::NotFound);
  EXPECT_FALSE(measurement_.pending());
}

TEST_F(Touch, AtTheVeryEndOfTheSearchCounts) {
  search();
  touch();
  EXPECT_EQ(see(0, true), Verdict::Touched);
}

TEST_F(Touch, IsNoHitOfTheSearchWhileThatIsHeld) {
  search();
  EXPECT_EQ(see(1, true), Verdict::Nothing);
  touch();
  EXPECT_EQ(see(1, true), Verdict::Nothing) << "somebody touched the probe by hand";
  EXPECT_EQ(measurement_.phase(), Measurement::Phase::Search);
}

TEST_F(Touch, ByAProbeThatIsDeflectedAlreadyOrHasNoPowerIsNone) {
  search();
  probe_.touching = true;
  EXPECT_EQ(see(1, false), Verdict::NotArmed);
  probe_.touching = false;
  search();
  probe_.ready = false;
  EXPECT_EQ(see(1, false), Verdict::ProbeLost);
}

TEST_F(Touch, WhereNothingIsExpectedIsUnexpected) {
  touch();
  EXPECT_EQ(see(1, false), Verdict::Unexpected);
  measurement_.begin(2);
  probe_.touching = false;
  (void)see(2, false);
  touch();
  EXPECT_EQ(see(2, false), Verdict::Unexpected) << "on the approach";
  EXPECT_FALSE(measurement_.pending());
  touch();
  EXPECT_EQ(see(0, true), Verdict::Nothing) << "at rest nobody is hurt";
}

TEST_F(Touch, ByHandIsExpectedWhenItWasSaid) {
  measurement_.expect_by_hand(true);
  touch();
  EXPECT_EQ(see(1, false), Verdict::Touched);
  EXPECT_FALSE(measurement_.pending());
}

TEST_F(Touch, ThatLastsAfterTheWayBackIsTold) {
  search();
  touch();
  (void)see(1, false);
  (void)see(0, true);
  measurement_.retract();
  EXPECT_EQ(see(0, true), Verdict::StillTouching);
}

}  // namespace
}  // namespace rmac::gateway
