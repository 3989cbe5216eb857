#include "gateway/rmac/program/request_order.hpp"

#include <gtest/gtest.h>

namespace rmac::cli {
namespace {

Request request(const std::string& method) {
  return {7, "", method, timing_of(method)};
}

const Request kMoveRequest = request("RMAC_CAM.MoveToXYZ");
const Request kMeasure = request("RMAC_CAM.AutoMeasure");
const Request kStartRequest = request("RMAC_CAM.CycleStart");
const Request kFeed = request("RMAC_CAM.SetFeedrate");
const Request kHome = request("RMAC_CAM.Home");

class RequestOrderTest : public testing::Test {
 protected:
  RequestOrderTest() { program_.file = "p.rmac"; }

  Program program_;
  RequestOrder order_{program_};
};

TEST_F(RequestOrderTest, AFirstMoveWaitsForRestAndTheNextOnesDoNot) {
  EXPECT_TRUE(order_.waits_for_rest(kMoveRequest)) << "somebody may have jogged";
  order_.sent(kMoveRequest);
  EXPECT_FALSE(order_.waits_for_rest(kMoveRequest));
}

TEST_F(RequestOrderTest, WhatActsOnTheMachineWaitsForRestAndSoDoesTheMoveBehindIt) {
  order_.sent(kMoveRequest);
  EXPECT_TRUE(order_.waits_for_rest(kHome));
  order_.sent(kHome);
  EXPECT_TRUE(order_.waits_for_rest(kMoveRequest));
  EXPECT_TRUE(order_.waits_for_rest(kStartRequest));
}

TEST_F(RequestOrderTest, WhatHoldsForLaterMovesWaitsForNothingAndSettlesNothing) {
  order_.sent(kHome);
  EXPECT_FALSE(order_.waits_for_rest(kFeed));
  order_.sent(kFeed);
  EXPECT_TRUE(order_.waits_for_rest(kMoveRequest));
}

TEST_F(RequestOrderTest, TheCycleIsStartedForAProgramThatDoesNotStartIt) {
  EXPECT_TRUE(order_.needs_cycle(kMoveRequest));
  EXPECT_FALSE(order_.needs_cycle(kFeed));
  order_.cycle_started();
  order_.sent(kMoveRequest);
  EXPECT_FALSE(order_.needs_cycle(kMoveRequest));
  order_.sent(kHome);
  EXPECT_TRUE(order_.needs_cycle(kMoveRequest)) << "homing ends the cycle";
}

TEST_F(RequestOrderTest, APointIsMeasuredWhenWhatStandsBetweenMovesIsDone) {
  order_.cycle_started();
  order_.sent(kMoveRequest);
  EXPECT_FALSE(order_.waits_for_rest(kMeasure));
  order_.sent(request("RMAC_CAM.Dwell"));
  order_.sent(kMoveRequest);
  EXPECT_FALSE(order_.waits_for_rest(kMoveRequest));
  EXPECT_TRUE(order_.waits_for_rest(kMeasure));
  order_.sent(kMeasure);
  EXPECT_FALSE(order_.waits_for_rest(kMeasure));
}

TEST_F(RequestOrderTest, AProgramThatStartsItsCycleDoesSoItself) {
  program_.starts_cycle = true;
  EXPECT_FALSE(order_.needs_cycle(kMoveRequest));
  EXPECT_FALSE(order_.started());
  order_.sent(kStartRequest);
  EXPECT_TRUE(order_.started());
}

TEST_F(RequestOrderTest, WhatFollowsAMeasuredPointWaitsForItOnceTheCycleRuns) {
  order_.sent(kMeasure);
  EXPECT_FALSE(order_.waits_for_measurement()) << "it would wait for ever";
  order_.cycle_started();
  EXPECT_TRUE(order_.waits_for_measurement());
  order_.sent(kMoveRequest);
  EXPECT_FALSE(order_.waits_for_measurement());
}

TEST_F(RequestOrderTest, RefusesToWaitForMovesThatAreStartedLater) {
  const auto refused = order_.check(kHome, true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "p.rmac:7: RMAC_CAM.Home needs the moves before it done, but the program starts its cycle later");
  EXPECT_TRUE(order_.check(kHome, false)) << "nothing is queued";
  EXPECT_TRUE(order_.check(kMoveRequest, true));
  order_.cycle_started();
  EXPECT_TRUE(order_.check(kHome, true));
}

TEST_F(RequestOrderTest, RefusesAnEndThatLeavesMovesInTheQueue) {
  const auto refused = order_.check_end(true);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "p.rmac: the program ends without starting its cycle");
  EXPECT_TRUE(order_.check_end(false));
  order_.cycle_started();
  EXPECT_TRUE(order_.check_end(true));
}

}  // namespace
}  // namespace rmac::cli
