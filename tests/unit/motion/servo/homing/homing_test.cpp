#include "servo/homing/homing.hpp"

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

using Progress = Homing::Progress;
using testing::ElementsAre;

constexpr std::uint16_t kRests = statusword::kTargetReached, kAttained = statusword::kHomingAttained;
constexpr int kSettle = 10;

/// Actuators 0 and 2 home in turn 3, actuator 1 in turn 1, actuator 3 never. 50 cycles for a turn.
class HomingByDrives : public testing::Test {
 protected:
  HomingByDrives() {
    for (std::uint32_t i = 0; i < 4; ++i) actuators_.push_back({bus_, i, {1000, 1, 1, 0}});
    actuators_[0].homing_turn = actuators_[2].homing_turn = 3;
    actuators_[1].homing_turn = 1;
    for (DriveFeedback& words : bus_->feedback) words.online = true;
  }
  void tell(std::size_t actuator, std::uint16_t status, DriveMode mode = DriveMode::Homing) {
    bus_->feedback[actuator].statusword = status;
    bus_->feedback[actuator].mode = mode;
  }
  Progress step(bool wanted = true) {
    shafts_->read();
    return homing_->step(wanted, *shafts_, faults_);
  }
  Progress steps(int count) {
    Progress last = Progress::UnderWay;
    for (int i = 0; i < count; ++i) last = step();
    return last;
  }
  void make() {
    homing_.emplace(actuators_, 0.0505, 0.001);
    shafts_.emplace(actuators_, 0.001);
  }
  DriveCommand command(std::size_t actuator) {
    DriveCommand words{.mode = DriveMode::CyclicSyncTorque};
    homing_->command(actuator, words);
    return words;
  }
  std::shared_ptr<ServoBus> bus_ = std::make_shared<ServoBus>(std::make_shared<FakeBus>(4));
  std::vector<ServoActuator> actuators_;
  std::optional<Homing> homing_;
  std::optional<Shafts> shafts_;
  RecordedFaults faults_;
};

TEST_F(HomingByDrives, GoesTurnByTurnUntilAllAreHome) {
  make();
  EXPECT_EQ(homing_->begin(), Progress::UnderWay);
  EXPECT_EQ(homing_->drives(), 0b0010U);
  tell(1, kRests | kAttained);
  EXPECT_EQ(steps(kSettle), Progress::UnderWay) << "a statusword of the homing before";
  EXPECT_EQ(homing_->drives(), 0b0010U);
  EXPECT_EQ(step(), Progress::UnderWay);
  EXPECT_EQ(homing_->drives(), 0b0111U) << "the next turn; who is home stays in homing mode";
  tell(0, kRests | kAttained);
  tell(2, kRests | kAttained);
  EXPECT_EQ(steps(kSettle), Progress::UnderWay);
  EXPECT_EQ(homing_->completed(), 0U);
  EXPECT_EQ(step(), Progress::Over);
  EXPECT_EQ(homing_->completed(), 1U);
  EXPECT_EQ(homing_->drives(), 0U);
}

TEST_F(HomingByDrives, WaitsForAllOfATurn) {
  make();
  (void)homing_->begin();
  tell(1, kRests | kAttained);
  (void)steps(kSettle + 1);
  tell(0, kRests | kAttained);
  tell(2, kRests);
  EXPECT_EQ(steps(kSettle + 5), Progress::UnderWay) << "at rest is not at home";
  tell(2, kAttained);
  EXPECT_EQ(step(), Progress::UnderWay) << "at home is not at rest";
  tell(2, kRests | kAttained);
  EXPECT_EQ(step(), Progress::Over);
}

TEST_F(HomingByDrives, IsOverAtOnceWhereNoDriveLooksForHome) {
  for (ServoActuator& actuator : actuators_) actuator.homing_turn = 0;
  make();
  EXPECT_EQ(homing_->begin(), Progress::Over);
  EXPECT_EQ(homing_->completed(), 1U);
}

TEST_F(HomingByDrives, DriveIsToldItsModeFirstAndToStartOnceItIsThere) {
  make();
  (void)homing_->begin();
  tell(1, 0, DriveMode::CyclicSyncTorque);
  EXPECT_EQ(command(1).mode, DriveMode::Homing);
  EXPECT_EQ(command(1).controlword, 0);
  tell(1, 0);
  EXPECT_EQ(command(1).controlword, controlword::kStartHoming);
  EXPECT_EQ(command(0).mode, DriveMode::CyclicSyncTorque) << "it is not its turn";
}

TEST_F(HomingByDrives, CountersThatJumpAreForgotten) {
  make();
  (void)homing_->begin();
  tell(1, 0);
  (void)step();
  EXPECT_FALSE((*shafts_)[1].seen());
  EXPECT_TRUE((*shafts_)[0].seen());
}

TEST_F(HomingByDrives, DriveThatGivesUpIsAFault) {
  make();
  (void)homing_->begin();
  tell(1, statusword::kHomingError);
  EXPECT_EQ(steps(kSettle), Progress::UnderWay);
  EXPECT_EQ(step(), Progress::Failed);
  EXPECT_THAT(faults_.raised, ElementsAre(is_fault(ServoFault::Kind::HomingFailed, ServoFault::Part::Actuator, 1,
                                                   statusword::kHomingError, 0)));
}

TEST_F(HomingByDrives, TakesNoLongerThanItMayTurnByTurn) {
  make();
  (void)homing_->begin();
  tell(1, kRests | kAttained);
  EXPECT_EQ(steps(40), Progress::UnderWay);
  ASSERT_EQ(homing_->drives(), 0b0111U);
  tell(0, kRests | kAttained);
  tell(2, 0x5);
  EXPECT_EQ(steps(21), Progress::UnderWay) << "29 cycles of this turn have passed, and these are all 50";
  EXPECT_EQ(step(), Progress::Failed);
  EXPECT_THAT(faults_.raised,
              ElementsAre(is_fault(ServoFault::Kind::HomingFailed, ServoFault::Part::Actuator, 2, 0x5, 0.0505)));
}

TEST_F(HomingByDrives, IsEndedByTheWishOnceTheDrivesRest) {
  make();
  (void)homing_->begin();
  tell(1, 0);
  (void)steps(20);
  EXPECT_EQ(step(false), Progress::UnderWay);
  EXPECT_EQ(command(1).controlword, 0) << "the bit falls, the mode stays";
  EXPECT_EQ(command(1).mode, DriveMode::Homing);
  tell(1, kRests | statusword::kHomingError);
  for (int i = 1; i < kSettle; ++i) EXPECT_EQ(step(false), Progress::UnderWay) << i;
  EXPECT_EQ(step(true), Progress::Over) << "it is not taken up again";
  EXPECT_EQ(homing_->completed(), 0U);
  EXPECT_TRUE(faults_.raised.empty());
  EXPECT_EQ(homing_->begin(), Progress::UnderWay);
  EXPECT_EQ(homing_->drives(), 0b0010U);
}

// Red when a drive that tells no rest in homing mode (HomingWithoutTargetReached) ends a stopped homing as one that
// found no home.
TEST_F(HomingByDrives, IsEndedByTheWishOnceTheDrivesStandThoughTheyDoNotTell) {
  homing_.emplace(actuators_, 10, 0.001);
  shafts_.emplace(actuators_, 0.001);
  (void)homing_->begin();
  tell(1, 0);
  (void)steps(20);
  std::int32_t& counts = bus_->feedback[1].position_counts;
  for (int i = 0; i < 300; ++i) {
    counts += i % 20 == 0 ? 1 : 0;  // 50 counts a second
    ASSERT_EQ(step(false), Progress::UnderWay) << i;
  }
  counts += 10;
  for (int i = 0; i < 99; ++i) {
    counts += i % 2 == 0 ? 1 : -1;
    ASSERT_EQ(step(false), Progress::UnderWay) << i;
  }
  Progress last = Progress::UnderWay;
  for (int i = 0; i < 3 && last == Progress::UnderWay; ++i) last = step(false);
  EXPECT_EQ(last, Progress::Over);
  EXPECT_TRUE(faults_.raised.empty());
  EXPECT_EQ(homing_->completed(), 0U);
}

}  // namespace
}  // namespace rmac::servo_test
