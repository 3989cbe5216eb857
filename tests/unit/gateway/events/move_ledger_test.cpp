#include "gateway/events/move_ledger.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::ElementsAre;

class MoveLedgerTest : public testing::Test {
 protected:
  std::vector<std::string> read(std::uint64_t moves_done, std::int64_t moving = 0) {
    CycleSample sample;
    sample.moves_done = moves_done;
    sample.moving = moving != 0;
    sample.move_id = moving;
    std::vector<std::string> told;
    ledger_.read(sample, [&](const Event& event) { told.push_back(event.message); });
    return told;
  }
  MoveLedger ledger_;
};

TEST_F(MoveLedgerTest, TellsOfMovesThatBeganAndEndedWithinACycle) {
  for (const std::int64_t id : {4, 5, 6}) ledger_.add(id, false);
  EXPECT_THAT(read(2, 6),
              ElementsAre("move 4 started", "move 4 done", "move 5 started", "move 5 done", "move 6 started"));
  EXPECT_THAT(read(3), ElementsAre("move 6 done"));
}

TEST_F(MoveLedgerTest, AMoveWithoutMotionIsDoneInItsTurn) {
  ledger_.add(4, false);
  ledger_.add(5, true);
  EXPECT_THAT(read(0, 4), ElementsAre("move 4 started"));
  EXPECT_THAT(read(1), ElementsAre("move 4 done", "move 5 started", "move 5 done"));
}

// Red when what a dwell that ends in cycle 7 has behind it is told before the dwell is: a client that waits for its
// moves in order then waits for ever.
TEST_F(MoveLedgerTest, AMoveWithoutMotionIsToldAfterTheCycleInWhichItWasQueued) {
  const auto read_cycle = [this](std::int64_t cycle, std::uint64_t moves_done) {
    CycleSample sample;
    sample.cycle = cycle;
    sample.moves_done = moves_done;
    std::vector<std::string> told;
    ledger_.read(sample, [&](const Event& event) { told.push_back(event.message); });
    return told;
  };
  ledger_.add(3, true, {}, {}, 7);
  ledger_.add(4, false, {}, {}, 7);
  EXPECT_THAT(read_cycle(6, 0), testing::IsEmpty());
  EXPECT_THAT(read_cycle(7, 0), testing::IsEmpty());
  EXPECT_THAT(read_cycle(8, 1), ElementsAre("move 3 started", "move 3 done", "move 4 started", "move 4 done"));
}

TEST_F(MoveLedgerTest, WhatIsDoneOnTheWayIsToldByItsName) {
  ledger_.add(4, false);
  ledger_.add(5, true, {}, "calls in turn 5 (Laser on)");
  EXPECT_THAT(read(1), ElementsAre("move 4 started", "move 4 done", "calls in turn 5 (Laser on) started",
                                   "calls in turn 5 (Laser on) done"));
}

TEST_F(MoveLedgerTest, AMoveInPartsBeginsAndEndsOnce) {
  ledger_.add(4, false, {.first = true, .last = false});
  ledger_.add(4, false, {.first = false, .last = true});
  EXPECT_THAT(read(1, 4), ElementsAre("move 4 started"));
  EXPECT_THAT(read(2), ElementsAre("move 4 done"));
}

TEST_F(MoveLedgerTest, CountsOnWhereMovesWereDroppedAndAnewForAnotherMechanism) {
  ledger_.add(4, false);
  EXPECT_THAT(read(1), ElementsAre("move 4 started", "move 4 done"));
  ledger_.add(5, false);
  ledger_.clear();
  ledger_.add(6, false);
  EXPECT_THAT(read(1, 6), ElementsAre("move 6 started"));
  ledger_.restart();
  ledger_.add(7, false);
  EXPECT_THAT(read(1), ElementsAre("move 7 started", "move 7 done"));
}

}  // namespace
}  // namespace rmac::gateway
