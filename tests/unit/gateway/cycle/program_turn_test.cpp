#include "gateway/cycle/program_turn.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class TurnOfAProgram : public testing::Test {
 protected:
  using Outcome = ProgramTurn::Outcome;

  Outcome take(const InTurn& step, double t_s, std::uint64_t inputs = 0) {
    news_.set_time(t_s, static_cast<std::int64_t>(t_s * 1000));
    return turn_.take(step, {.t_s = t_s, .inputs = inputs});
  }
  [[nodiscard]] std::vector<Event> told() { return news_.take().events; }

  LatestValue<ServoWishes> servo_;
  StandingWishes wishes_{servo_};
  CycleNews news_;
  ProgramTurn turn_{wishes_, news_};
};

TEST_F(TurnOfAProgram, DwellsAsLongAsTheCycleRuns) {
  const InTurn dwell{7, Dwell{2}};
  EXPECT_EQ(take(dwell, 10), Outcome::Waits);
  EXPECT_STREQ(turn_.waits_for(), "dwell");
  EXPECT_EQ(servo_.read().in_turn, 7) << "samples show what is done";
  EXPECT_EQ(take(dwell, 11), Outcome::Waits);
  turn_.pause();  // a hold of a hundred seconds
  EXPECT_EQ(take(dwell, 111), Outcome::Waits) << "time that it was held does not count";
  EXPECT_EQ(take(dwell, 111.999), Outcome::Waits);
  EXPECT_EQ(take(dwell, 112), Outcome::Done);
  EXPECT_STREQ(turn_.waits_for(), "");
  EXPECT_EQ(servo_.read().in_turn, std::nullopt);
  const auto events = told();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[0].kind, Event::Kind::MoveStarted);
  EXPECT_EQ(events[0].t_s, 10);
  EXPECT_EQ(events[0].move_id, 7);
  EXPECT_EQ(events[1].kind, Event::Kind::MoveDone);
  EXPECT_EQ(events[1].t_s, 112);
  EXPECT_EQ(events[1].move_id, 7);
}

TEST_F(TurnOfAProgram, IsDoneAtOnceWhereThereIsNothingToWaitFor) {
  EXPECT_EQ(take({1, Dwell{0}}, 1), Outcome::Done);
  EXPECT_EQ(take({2, AwaitInput{.bit = 4, .on = true, .timeout_s = 0, .name = "Up"}}, 1, 4), Outcome::Done);
  EXPECT_EQ(take({3, ProgramStop{.optional = true}}, 1), Outcome::Done) << "optional stops are off at first";
  EXPECT_EQ(told().size(), 6U) << "each began and is done";
}

TEST_F(TurnOfAProgram, HoldsAtAStopUntilItIsAskedAgain) {
  const InTurn stop{4, ProgramStop{.message = "turn the part over"}};
  EXPECT_EQ(take(stop, 1), Outcome::Held);
  EXPECT_EQ(turn_.prompt(), "program stop 4: turn the part over");
  const auto events = told();
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].kind, Event::Kind::ProgramStopped);
  EXPECT_EQ(events[1].code, MinorCode::None);
  EXPECT_THAT(events[1].message, HasSubstr("turn the part over; the program is held: FeedResume goes on"));
  turn_.pause();
  EXPECT_EQ(take(stop, 60), Outcome::Done);
  EXPECT_EQ(turn_.prompt(), "");
}

TEST_F(TurnOfAProgram, HoldsAtAnOptionalStopAsTheSwitchIsWhenItsTurnComes) {
  turn_.set_optional_stops(true);
  EXPECT_EQ(take({5, ProgramStop{.optional = true}}, 1), Outcome::Held);
  EXPECT_EQ(turn_.prompt(), "optional stop 5");
  turn_.set_optional_stops(false);
  EXPECT_EQ(take({5, ProgramStop{.optional = true}}, 2), Outcome::Done);
  EXPECT_EQ(take({6, ProgramStop{.optional = true}}, 3), Outcome::Done);
  EXPECT_EQ(take({7, ProgramStop{}}, 4), Outcome::Held) << "the switch is for optional ones";
}

TEST_F(TurnOfAProgram, HoldsWhenAnInputDoesNotComeAndWaitsOnceMoreWhenAskedAgain) {
  const InTurn input{8, AwaitInput{.bit = 0b100, .on = true, .timeout_s = 2, .name = "Clamped"}};
  EXPECT_EQ(take(input, 10, 0b011), Outcome::Waits);
  EXPECT_STREQ(turn_.waits_for(), "input");
  EXPECT_EQ(take(input, 12, 0b011), Outcome::Waits);
  EXPECT_EQ(take(input, 12.1, 0b011), Outcome::Held);
  EXPECT_EQ(turn_.prompt(), "wait for an input 8: input Clamped did not go on within 2 s");
  const auto events = told();
  EXPECT_EQ(events.back().kind, Event::Kind::ProgramStopped);
  EXPECT_EQ(events.back().code, MinorCode::ResponseTimeout);
  EXPECT_THAT(events.back().message, HasSubstr("input Clamped did not go on within 2 s; the program is held"));
  turn_.pause();
  EXPECT_EQ(take(input, 100, 0b011), Outcome::Waits);
  EXPECT_EQ(turn_.prompt(), "");
  EXPECT_EQ(take(input, 101, 0b100), Outcome::Done);
  EXPECT_EQ(take({9, AwaitInput{.bit = 1, .on = false, .timeout_s = 0, .name = "Door"}}, 102, 1), Outcome::Waits);
  EXPECT_EQ(take({9, AwaitInput{.bit = 1, .on = false, .timeout_s = 0, .name = "Door"}}, 102.001, 1), Outcome::Held);
  EXPECT_EQ(turn_.take({9, AwaitInput{.bit = 1, .on = false, .name = "Door"}},
                       {.t_s = 103, .inputs = 1, .virtual_mode = true}),
            Outcome::Done)
      << "no device is behind it";
}

TEST_F(TurnOfAProgram, SwitchesSpindlesAndOutputsTogetherInTheirOrder) {
  wishes_.change([](ServoWishes& wish) {
    wish.spindle_rpm = {100, 200};
    wish.outputs = 0b1001;
  });
  const Switch outputs{.outputs = {{"A", true, 0b10}, {"B", false, 0b1}, {"C", true, 0b100}, {"C", false, 0b100}}};
  EXPECT_EQ(take({1, outputs}, 1), Outcome::Done);
  EXPECT_EQ(servo_.read().outputs, 0b1010U) << "the last word counts, and others stay";
  EXPECT_EQ(servo_.read().spindle_rpm[0], 100);
  const Switch both{.speeds = {{1, -500}}, .outputs = {{"B", true, 0b1}}};
  EXPECT_EQ(take({2, both}, 2), Outcome::SpindlesTold);
  EXPECT_EQ(servo_.read().spindle_rpm[0], 100);
  EXPECT_EQ(servo_.read().spindle_rpm[1], -500);
  EXPECT_EQ(servo_.read().outputs, 0b1011U);
  const auto events = told();
  ASSERT_EQ(events.size(), 4U);
  EXPECT_EQ(events[3].kind, Event::Kind::MoveDone);
  EXPECT_EQ(events[3].message, "calls in turn 2 (spindle 1 at -500 rpm, B on) done");
}

TEST_F(TurnOfAProgram, BeginsAnewAfterTheQueueWasEmptied) {
  EXPECT_EQ(take({1, Dwell{5}}, 1), Outcome::Waits);
  turn_.drop();
  EXPECT_STREQ(turn_.waits_for(), "");
  EXPECT_EQ(servo_.read().in_turn, std::nullopt);
  (void)told();
  EXPECT_EQ(take({2, Dwell{5}}, 5.9), Outcome::Waits) << "another step, with all its time";
  EXPECT_EQ(take({2, Dwell{5}}, 7), Outcome::Waits);
  EXPECT_EQ(told().front().move_id, 2);
  EXPECT_EQ(take({2, ProgramStop{}}, 8), Outcome::Held);
  turn_.drop();
  EXPECT_EQ(turn_.prompt(), "");
}

}  // namespace
}  // namespace rmac::gateway
