// Who is told of what, and in which order. The test is the servo thread and the motion supervisor at once.
#include "gateway/events/announcer.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::ElementsAre;

class AnnouncerTest : public testing::Test {
 protected:
  AnnouncerTest() {
    announcer_.on_sample(
        [this](const CycleSample& sample) { told_.push_back(fmt::format("sample {}", sample.cycle)); });
    announcer_.on_event([this](const Event& event) { told_.push_back(event.message); });
  }
  void run_cycle(std::int64_t move_id = 0, std::uint64_t moves_done = 0) {
    CycleSample sample;
    sample.cycle = ++cycle_;
    sample.move_id = move_id;
    sample.moving = move_id != 0;
    sample.moves_done = moves_done;
    link_.history.add(sample);
  }
  void fault(std::int64_t cycle) {
    FaultRecord record;
    record.cycle = cycle;
    record.generation = 3;
    record.fault.kind = ServoFault::Kind::NotANumber;
    ASSERT_TRUE(link_.faults.push(record));
  }
  static Event event(std::int64_t cycle, const std::string& message, Event::Kind kind = Event::Kind::Authority) {
    return {kind, 0, 0, message, cycle, {}};
  }

  std::int64_t cycle_ = 0;
  ServoLink link_{1};
  std::vector<std::uint64_t> generations_;
  Announcer announcer_{link_, [this](std::uint64_t generation) -> const Mechanism* {
                         generations_.push_back(generation);
                         return nullptr;
                       }};
  std::vector<std::string> told_;
};

TEST_F(AnnouncerTest, TellsEventsBetweenTheSamplesOfTheirCycles) {
  for (int i = 0; i < 3; ++i) run_cycle();
  announcer_.announce({{}, {event(3, "third"), event(1, "first")}});
  EXPECT_THAT(told_, ElementsAre("sample 1", "first", "sample 2", "sample 3", "third"));
}

TEST_F(AnnouncerTest, TellsAFaultOfTheServoThreadInItsPlaceAndAsksWhoseItIs) {
  for (int i = 0; i < 3; ++i) run_cycle();
  fault(2);
  announcer_.announce({{}, {event(2, "to Faulted")}});
  ASSERT_EQ(told_.size(), 5U);
  EXPECT_THAT(told_[2], testing::HasSubstr("joint 0 of the mechanism before: the servo loop computed no number"));
  EXPECT_EQ(told_[3], "to Faulted");
  EXPECT_THAT(generations_, ElementsAre(3U));
  ASSERT_TRUE(announcer_.last_stop());
  EXPECT_EQ(announcer_.last_stop()->cycle, 2);
}

TEST_F(AnnouncerTest, TellsOfMovesFromSamples) {
  run_cycle(8);
  run_cycle(8);
  run_cycle(0, 1);
  announcer_.announce({{{QueueChange::Kind::Added, 8, 0, {}}}, {}});
  EXPECT_THAT(told_, ElementsAre("sample 1", "move 8 started", "sample 2", "sample 3", "move 8 done"));
}

// Red when calls that are done in the cycle in which a move without motion before them was, are told before it: a
// client that waits for its moves in order then waits for ever. So did `rmac simulate`.
TEST_F(AnnouncerTest, WhatWasDoneFirstIsToldFirstThoughItWasInOneCycle) {
  run_cycle();
  CycleNews news;
  news.set_time(0.001, 1);
  news.tell(Event::Kind::ToolChanged, "the tool is in");
  news.tell(QueueChange{QueueChange::Kind::Still, 4, 0, {}, {}});
  news.tell(QueueChange{QueueChange::Kind::Still, 5, 0, {}, {}});
  news.tell(Event::Kind::MoveDone, "calls in turn 6 done");
  news.tell(QueueChange{QueueChange::Kind::Added, 7, 0, {}, {}});
  news.tell(QueueChange{QueueChange::Kind::Still, 8, 0, {}, {}});
  news.tell(Event::Kind::CycleStateChanged, "Running to Holding");
  announcer_.announce(news.take());
  EXPECT_THAT(told_, ElementsAre("sample 1", "the tool is in", "move 4 started", "move 4 done", "move 5 started",
                                 "move 5 done", "calls in turn 6 done", "Running to Holding"));
  told_.clear();
  run_cycle(0, 1);
  announcer_.announce({});
  EXPECT_THAT(told_, ElementsAre("sample 2", "move 7 started", "move 7 done", "move 8 started", "move 8 done"));
}

TEST_F(AnnouncerTest, MovesThatWereDroppedAreNotDoneInTheCyclesAfterThat) {
  run_cycle(8);
  run_cycle(8);
  run_cycle(9);
  announcer_.announce({{{QueueChange::Kind::Added, 8, 0, {}},
                        {QueueChange::Kind::Cleared, 0, 2, {}},
                        {QueueChange::Kind::Added, 9, 0, {}}},
                       {}});
  EXPECT_THAT(told_, ElementsAre("sample 1", "move 8 started", "sample 2", "sample 3", "move 9 started"));
}

TEST_F(AnnouncerTest, AnotherMechanismCountsItsMovesFromZero) {
  run_cycle(8);
  run_cycle(0, 1);
  run_cycle(9);
  run_cycle(0, 1);
  announcer_.announce({{{QueueChange::Kind::Added, 8, 0, {}},
                        {QueueChange::Kind::Replaced, 0, 2, {}},
                        {QueueChange::Kind::Added, 9, 0, {}}},
                       {}});
  EXPECT_THAT(told_, ElementsAre("sample 1", "move 8 started", "sample 2", "move 8 done", "sample 3", "move 9 started",
                                 "sample 4", "move 9 done"));
}

TEST_F(AnnouncerTest, ShowsEventsToThoseWhoAddToThemFirst) {
  announcer_.before_event([](Event& event) { event.message += ", recorded"; });
  announcer_.tell(event(1, "stop", Event::Kind::Stopped));
  EXPECT_THAT(told_, ElementsAre("stop, recorded"));
  EXPECT_EQ(announcer_.last_stop()->message, "stop, recorded");
  announcer_.tell(event(2, "somebody else has authority"));
  EXPECT_EQ(announcer_.last_stop()->message, "stop, recorded") << "no stop";
}

TEST_F(AnnouncerTest, TellsWhatASampleBringsAboutBehindIt) {
  announcer_.after_sample([](const CycleSample& sample, const Announcer::Tell& tell) {
    if (sample.cycle == 1) tell(event(1, "hit"));
  });
  run_cycle();
  run_cycle();
  announcer_.announce({});
  EXPECT_THAT(told_, ElementsAre("sample 1", "hit", "sample 2"));
}

TEST_F(AnnouncerTest, KeepsSamplesThatWereTakenOverMeanwhileForTheNextAnnouncement) {
  run_cycle();
  announcer_.take_over_samples();
  EXPECT_TRUE(told_.empty());
  run_cycle();
  announcer_.announce({});
  EXPECT_THAT(told_, ElementsAre("sample 1", "sample 2"));
}

}  // namespace
}  // namespace rmac::gateway
