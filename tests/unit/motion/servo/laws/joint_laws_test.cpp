#include "servo/laws/joint_laws.hpp"

#include "unit/motion/servo/recorded_faults.hpp"
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

/// Two joints with laws of 0.1 N/mm and a bound of 5 N, and one whose drive closes its loop itself.
class LawsOfJoints : public testing::Test {
 protected:
  LawsOfJoints() {
    joints_.resize(3);
    for (std::size_t j = 0; j < 2; ++j) {
      joints_[j].law = laws_[j] = std::make_shared<RecordingLaw>();
      joints_[j].max_effort = 5;
    }
  }
  static ServoInput error(double mm) { return {.position_setpoint = mm}; }
  std::array<std::shared_ptr<RecordingLaw>, 2> laws_;
  std::vector<ServoJoint> joints_;
  RecordedFaults faults_;
};

TEST_F(LawsOfJoints, HaveTheirEffortLimit) {
  const JointLaws laws(joints_, kPeriod);
  EXPECT_EQ(laws_[1]->limit, 5);
  EXPECT_TRUE(laws.has_law(1));
  EXPECT_FALSE(laws.has_law(2));
}

TEST_F(LawsOfJoints, GiveEffortsWithinTheBound) {
  JointLaws laws(joints_, kPeriod);
  EXPECT_TRUE(laws.run(0, error(20), {}, faults_));
  EXPECT_EQ(laws.effort()[0], 2);
  EXPECT_TRUE(laws.run(0, error(-200), {}, faults_));
  EXPECT_EQ(laws.effort()[0], -5);
  EXPECT_EQ(laws.effort()[1], 0);
}

TEST_F(LawsOfJoints, GoOnFromTheEffortThereIsWhereAnEffortBesideBeginsAndEnds) {
  JointLaws laws(joints_, kPeriod);
  EXPECT_TRUE(laws.run(0, error(20), {}, faults_));
  EXPECT_TRUE(laws.run(0, error(0), 1.0, faults_));
  EXPECT_EQ(laws.effort()[0], 3);
  EXPECT_TRUE(laws.run(0, error(0), 2.0, faults_));
  EXPECT_EQ(laws.effort()[0], 4);
  EXPECT_TRUE(laws.run(0, error(0), -300.0, faults_));
  EXPECT_EQ(laws.effort()[0], -5) << "both together within the bound";
  EXPECT_TRUE(laws.run(0, error(0), {}, faults_));
  EXPECT_EQ(laws.effort()[0], -5);
  EXPECT_EQ(laws_[0]->engaged, 2);
}

TEST_F(LawsOfJoints, RestWithWhatTheLawKnowsWithinTheBound) {
  JointLaws laws(joints_, kPeriod);
  laws_[0]->resting = 3;
  laws_[1]->resting = -30;
  laws.rest(0);
  laws.rest(1);
  EXPECT_EQ(laws.effort()[0], 3);
  EXPECT_EQ(laws.effort()[1], -5);
  laws_[1]->resting = std::numeric_limits<double>::infinity();
  EXPECT_EQ(laws.resting_effort(1), 0);
  EXPECT_EQ(laws.resting_effort(2), 0);
}

TEST_F(LawsOfJoints, GoOnFromTheEffortThatTheyAreEngagedWithFiltersIncluded) {
  joints_[0].mechanics.low_pass_hz = 50;
  JointLaws laws(joints_, kPeriod);
  laws.engage(0, error(20), 3);
  EXPECT_EQ(laws_[0]->engaged, 1);
  EXPECT_TRUE(laws.run(0, error(20), {}, faults_));
  EXPECT_NEAR(laws.effort()[0], 3, 1e-9);
  laws.engage(2, error(20), 3);  // it has none, and nothing happens
}

TEST_F(LawsOfJoints, NoNumberIsAFaultAndNoJointHasAnEffort) {
  JointLaws laws(joints_, kPeriod);
  EXPECT_TRUE(laws.run(0, error(20), {}, faults_));
  laws_[1]->answer_nan = true;
  EXPECT_FALSE(laws.run(1, error(0), {}, faults_));
  EXPECT_EQ(laws.effort()[0], 0);
  EXPECT_EQ(laws.effort()[1], 0);
  ASSERT_EQ(faults_.raised.size(), 1U);
  EXPECT_EQ(faults_.raised[0].kind, ServoFault::Kind::NotANumber);
  EXPECT_EQ(faults_.raised[0].part, ServoFault::Part::Joint);
  EXPECT_EQ(faults_.raised[0].index, 1U);
  EXPECT_TRUE(std::isnan(faults_.raised[0].value));
}

TEST_F(LawsOfJoints, AreLetGoOneByOneAndAll) {
  JointLaws laws(joints_, kPeriod);
  laws.take_over(0, 1.5);
  laws.take_over(1, -2.5);
  laws.let_go(0);
  EXPECT_EQ(laws.effort()[0], 0);
  EXPECT_EQ(laws.effort()[1], -2.5);
  laws.let_go();
  EXPECT_EQ(laws.effort()[1], 0);
}

}  // namespace
}  // namespace rmac::servo_test
