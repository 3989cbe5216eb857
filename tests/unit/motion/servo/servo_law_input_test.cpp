// What a law is told of the effort at its joint.
#include "unit/motion/servo/servo_fixture.hpp"

namespace rmac::servo_test {
namespace {

class ServoLawInput : public ServoLoopTest {};

TEST_F(ServoLawInput, EffortIsMeasuredByTheDrivesThroughTheMap) {
  fake->torque_told = 0b111;
  build(parts(std::make_shared<DifferentialMap>()));
  engage();
  fake->drives[0].words.torque_permille = 300;
  fake->drives[1].words.torque_permille = 100;
  cycle();
  EXPECT_TRUE(laws[0]->last.effort_measured);
  EXPECT_NEAR(laws[0]->last.effort, 0.4, 1e-9);
  EXPECT_NEAR(laws[1]->last.effort, 0.2, 1e-9);
  EXPECT_NEAR(laws[2]->last.effort, 0, 1e-9);
}

TEST_F(ServoLawInput, EffortIsTheOneCommandedBeforeWhereADriveDoesNotTell) {
  fake->torque_told = 0b010;
  build();
  engage();
  fake->drives[0].words.torque_permille = 300;
  laws[0]->bias = 2;
  cycle();
  EXPECT_FALSE(laws[0]->last.effort_measured);
  EXPECT_EQ(laws[0]->last.effort, 0);
  cycle();
  EXPECT_EQ(laws[0]->last.effort, 2) << "of the cycle before, not of the drive";
  laws[0]->bias = 900;
  cycle(2);
  EXPECT_EQ(laws[0]->last.effort, 5) << "after its bound";
  EXPECT_TRUE(laws[1]->last.effort_measured);
}

TEST_F(ServoLawInput, EffortOfASpindleIsItsTorque) {
  for (const bool told : {true, false}) {
    fake->torque_told = told ? 0b1000 : 0;
    const auto law = std::make_shared<RecordingLaw>();
    ServoLoopParts made = parts();
    made.spindles[0].mode = DriveMode::CyclicSyncTorque;
    made.spindles[0].law = law;
    made.spindles[0].scale = {1000, 2, -1, 0};
    made.spindles[0].max_acceleration_rpm_s = 1000;
    made.spindles[0].max_torque_nm = 3;
    build(std::move(made));
    command = {};
    report = {};
    engage();
    fake->drives[3].words.torque_permille = 250;
    law->bias = 1.5;
    cycle(2);
    EXPECT_EQ(law->last.effort_measured, told);
    EXPECT_EQ(law->last.effort, told ? -0.5 : 1.5);
  }
}

}  // namespace
}  // namespace rmac::servo_test
