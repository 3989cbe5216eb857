// RMAC_CAM's FeedRetrace: back along the path of what is held, and forward again.
#include <gmock/gmock.h>

#include "unit/gateway/test_machine.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A mill held on the second of three lines along X, at a feed so slow that it is there when the test looks.
class FeedRetrace : public testing::Test {
 protected:
  void SetUp() override {
    const auto loaded = machine_.load_at_zero(TestMachine::mill());
    ASSERT_TRUE(loaded) << loaded.error().message;
    ASSERT_TRUE(cam().path().set_feedrate(120));
    ASSERT_TRUE(machine_.line(1, {0, 0, 0}, {5, 0, 0}));
    ASSERT_TRUE(machine_.line(2, {5, 0, 0}, {45, 0, 0}));
    ASSERT_TRUE(machine_.line(3, {45, 0, 0}, {45, 1, 0}));
    ASSERT_TRUE(cam().cycle().start(sdk::CycleMode::Automatic));
    ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveStarted, 2));
    hold();
  }
  void hold() {
    ASSERT_TRUE(cam().cycle().hold());
    ASSERT_TRUE(machine_.run_until([&] { return !machine_.samples.back().moving; }));
  }
  sdk::RmacCam& cam() { return machine_.controller.cam(); }
  [[nodiscard]] CycleState state() { return machine_.controller.cycle_now().state; }
  [[nodiscard]] double x() { return machine_.controller.sample().position_set[0]; }
  void retrace_to_rest(double distance) {
    const int before = machine_.count(Event::Kind::Stopped);
    const auto way = cam().cycle().retrace(distance);
    ASSERT_TRUE(way) << way.error().message;
    ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > before; }));
  }
  [[nodiscard]] std::vector<std::int64_t> done() const {
    std::vector<std::int64_t> ids;
    for (const Event& event : machine_.events) {
      if (event.kind == Event::Kind::MoveDone) ids.push_back(event.move_id);
    }
    return ids;
  }
  TestMachine machine_;
};

TEST_F(FeedRetrace, GoesBackTheDistanceHoldsThereAndFinishesTheProgramForward) {
  const double held = x();
  retrace_to_rest(3);
  EXPECT_EQ(state(), CycleState::Holding);
  EXPECT_NEAR(x(), held - 3, 1e-6);
  retrace_to_rest(1000);
  EXPECT_NEAR(x(), 0, 1e-6) << "the way back ends where the path began";
  EXPECT_THAT(done(), ElementsAre(1));
  ASSERT_TRUE(cam().cycle().set_feed_override(200));
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 3));
  EXPECT_THAT(done(), ElementsAre(1, 2, 3));
  EXPECT_NEAR(x(), 45, 1e-6);
}

TEST_F(FeedRetrace, IsTurnedForwardByAResumeUnderWay) {
  ASSERT_TRUE(cam().cycle().retrace(4));
  const auto start = cam().cycle().start(sdk::CycleMode::Automatic);
  if (state() == CycleState::Running) {
    ASSERT_FALSE(start);
    EXPECT_THAT(start.error().message, HasSubstr("FeedResume turns it forward"));
  }
  ASSERT_TRUE(cam().cycle().set_feed_override(200));
  ASSERT_TRUE(cam().cycle().resume());
  ASSERT_TRUE(machine_.run_until_event(Event::Kind::MoveDone, 3));
  EXPECT_THAT(done(), ElementsAre(1, 2, 3));
}

TEST_F(FeedRetrace, LeavesTheQueueToBeEmptiedAndAJogToBeginWhereTheToolStands) {
  retrace_to_rest(2);
  const double here = x();
  const int before = machine_.count(Event::Kind::Stopped);
  ASSERT_TRUE(cam().cycle().stop_now());
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > before; }));
  ASSERT_TRUE(cam().positioning().jog_joint(0, -1));
  ASSERT_TRUE(machine_.run_until([&] { return machine_.count(Event::Kind::Stopped) > before + 1; }));
  EXPECT_NEAR(x(), here - 1, 1e-6);
  EXPECT_THAT(cam().cycle().retrace(1).error().message, HasSubstr("send FeedHold first"));
}

TEST_F(FeedRetrace, IsRefusedWhereThereIsNothingBehind) {
  retrace_to_rest(1000);
  const auto refused = cam().cycle().retrace(1);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("no path behind the tool"));
  EXPECT_EQ(state(), CycleState::Holding);
}

TEST_F(FeedRetrace, IsRefusedInMotion) {
  ASSERT_TRUE(cam().cycle().resume());
  const auto refused = cam().cycle().retrace(1);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("the machine is Running"));
}

}  // namespace
}  // namespace rmac::gateway
