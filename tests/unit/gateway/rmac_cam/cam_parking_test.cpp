// What a program takes with it when it is parked; its place and its way back are the motion supervisor's.
#include "gateway/rmac_cam/cam_parking.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class ParkedProgram : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    spindles_.mechanism_changed();
    ASSERT_TRUE(path_.set_feedrate(600));
    ASSERT_TRUE(joints_.set_interp_speed(30));
    ASSERT_TRUE(spindles_.set_max_rpm(0, 700));
    ASSERT_TRUE(queue_line(4, {0, 0, 0}, {10, 0, 0}));
  }
  /// Everything starts anew, as another program would have it.
  void forget() {
    path_.mechanism_changed(true);
    joints_.mechanism_changed(true);
    spindles_.mechanism_changed();
  }
  CamForces forces_{device_, supervisor_};
  CamSpindles spindles_{device_, supervisor_, link_.history, tools_};
  CamProgramFlow flow_{device_, supervisor_, spindles_};
  CamParking parking_{device_, supervisor_, link_, {path_, joints_, spindles_, tools_, forces_, flow_}};
};

TEST_F(ParkedProgram, EmptiesTheQueueAndTellsWhatIsParked) {
  supervisor_.wish([](ServoWishes& wishes) {
    wishes.force[0] = 10;
    wishes.outputs = 0b100001;
  });
  ASSERT_TRUE(parking_.park());
  EXPECT_EQ(supervisor_.moves_left(), 0U);
  EXPECT_EQ(supervisor_.wishes().force[0], 0);
  EXPECT_EQ(supervisor_.wishes().outputs, 1U) << "the coolant is off";
  stand_at({0.3, 0.4, 0});
  const auto parked = parking_.parked();
  ASSERT_TRUE(parked);
  EXPECT_EQ(parked->mechanism, "Mill");
  EXPECT_EQ(parked->moves, 1U);
  EXPECT_EQ(parked->move_id, 4);
  EXPECT_DOUBLE_EQ(parked->off_mm, 0.5);
}

TEST_F(ParkedProgram, GivesBackTheSettingsThatTheProgramRanAt) {
  ASSERT_TRUE(parking_.park());
  forget();
  ASSERT_TRUE(path_.set_feedrate(60));
  const auto taken = parking_.take_up();
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(path_.feed_mm_s(), 10);
  EXPECT_EQ(joints_.interp_speed(), 30);
  EXPECT_EQ(spindles_.max_rpm(0).value(), 700);
  EXPECT_EQ(supervisor_.state(), CycleState::Holding);
  EXPECT_FALSE(parking_.parked());
}

TEST_F(ParkedProgram, TakesWhatStandsBetweenItsMovesAlongInItsPlace) {
  sdk::DeviceObject named = mechanism_->device;
  named.inputs = {{"Clamped", 3}};
  device_.change(&named);
  ASSERT_TRUE(flow_.dwell(5, 1.5));
  ASSERT_TRUE(queue_line(6, {10, 0, 0}, {10, 4, 0}));
  ASSERT_TRUE(flow_.stop(7, true, "look"));
  ASSERT_TRUE(flow_.await_input(8, "Clamped", false, 2));
  ASSERT_TRUE(flow_.in_turn(9, {sdk::SpindleCall{0, 300}, sdk::OutputCall{"Coolant", true}}));
  ASSERT_TRUE(parking_.park());
  EXPECT_EQ(supervisor_.moves_left(), 0U);
  EXPECT_EQ(parking_.parked()->moves, 6U);
  const auto ids = [&] {
    std::vector<std::int64_t> found;
    for (const Move& move : queued_) found.push_back(move.id);
    return found;
  };
  queued_.clear();
  named.inputs = {{"Other", 3}};
  const auto refused = parking_.take_up();
  ASSERT_FALSE(refused) << "the machine has another I/O interface now";
  EXPECT_THAT(refused.error().message, HasSubstr("no input named \"Clamped\""));
  EXPECT_EQ(supervisor_.moves_left(), 0U) << "nothing of it stays queued";
  named.inputs = {{"Clamped", 2}};
  queued_.clear();
  const auto taken = parking_.take_up();
  ASSERT_TRUE(taken) << taken.error().message;
  EXPECT_EQ(supervisor_.moves_left(), 6U);
  EXPECT_THAT(ids(), testing::ElementsAre(4, 5, 6, 7, 8, 9));
}

TEST_F(ParkedProgram, GoesOnWithADwellAtItsPlace) {
  ASSERT_TRUE(supervisor_.command(
      [](CycleSequencer& cycle, const CycleObservation& seen) { return cycle.stop_and_clear(seen); }));
  status_.t_s = 1;
  link_.status.write(status_);
  (void)supervisor_.advance(status_);
  ASSERT_TRUE(flow_.dwell(5, 1.5));
  ASSERT_TRUE(queue_line(6, {0, 0, 0}, {10, 4, 0}));
  ASSERT_TRUE(parking_.park());
  EXPECT_EQ(parking_.parked()->move_id, 5);
  stand_at({0.5, 0, 0});
  queued_.clear();
  const auto taken = parking_.take_up();
  ASSERT_TRUE(taken) << taken.error().message;
  ASSERT_EQ(queued_.size(), 3U) << "the way back, the dwell, the move";
  EXPECT_EQ(queued_[1].id, 5);
  EXPECT_EQ(queued_[2].id, 6);
}

TEST_F(ParkedProgram, KeepsTheProgramAndTheSettingsInForceOnARefusal) {
  ASSERT_TRUE(parking_.park());
  forget();
  stand_at({0, 5, 0});
  const auto refused = parking_.take_up();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("; the program stays parked"));
  EXPECT_EQ(path_.feed_mm_s(), 0);
  EXPECT_EQ(joints_.interp_speed(), 100);
  EXPECT_TRUE(parking_.parked());
}

TEST_F(ParkedProgram, IsOfTheMechanismThatItWasParkedOn) {
  ASSERT_TRUE(parking_.park());
  sdk::DeviceObject other = mechanism_->device;
  other.name = "Probe";
  device_.change(&other);
  EXPECT_THAT(parking_.take_up().error().message, HasSubstr("was parked on Mill in virtual mode; load that first"));
}

TEST_F(ParkedProgram, SaysThatNothingIsParked) {
  EXPECT_FALSE(parking_.parked());
  EXPECT_THAT(parking_.take_up().error().message, HasSubstr("TakeUpProgram: no program is parked"));
  EXPECT_THAT(parking_.drop().error().message, HasSubstr("DropParkedProgram: no program is parked"));
  ASSERT_TRUE(parking_.park());
  ASSERT_TRUE(parking_.drop());
  EXPECT_FALSE(parking_.parked());
}

TEST_F(ParkedProgram, NeedsAMechanism) {
  device_.change(nullptr);
  EXPECT_THAT(parking_.park().error().message, HasSubstr("ParkProgram: no mechanism is loaded"));
  EXPECT_THAT(parking_.take_up().error().message, HasSubstr("TakeUpProgram: no mechanism is loaded"));
}

}  // namespace
}  // namespace rmac::gateway
