#include "gateway/rmac_cam/cam_forces.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;

class Forces : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    pressing_ = mechanism_->device;
    pressing_.joints[1].method = ControlMethod::Force;
    pressing_.joints[1].force = ForceControl{.contact_force = 2, .max_force = 100};
    describe(pressing_);
  }
  sdk::DeviceObject pressing_;
  CamForces forces_{device_, supervisor_};
};

TEST_F(Forces, AreWishedOfTheServoLoop) {
  ASSERT_TRUE(forces_.set(1, -20));
  EXPECT_EQ(supervisor_.wishes().force[1], -20);
  EXPECT_EQ(supervisor_.wishes().force[0], 0);
  forces_.let_go();
  EXPECT_EQ(supervisor_.wishes().force[1], 0);
}

TEST_F(Forces, TellContactAndStayBelowTheMost) {
  for (const double force : {2.0, -2.0, 100.0, 0.0}) EXPECT_TRUE(forces_.set(1, force)) << force;
  for (const double force : {1.9, -1.9, 100.1, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(forces_.set(1, force).error().code, MinorCode::InvalidParameterValue) << force;
  }
}

TEST_F(Forces, AreOfJointsUnderForceControlAlone) {
  EXPECT_THAT(forces_.set(0, 20).error().message, HasSubstr("joint 0 (X) is under position control"));
  pressing_.joints[0].method = ControlMethod::Velocity;
  EXPECT_THAT(forces_.set(0, 20).error().message, HasSubstr("joint 0 (X) is under velocity control"));
  EXPECT_FALSE(forces_.set(3, 20));
}

TEST_F(Forces, ComeBackAfterAResetOnly) {
  fail();
  EXPECT_THAT(forces_.set(1, 20).error().message, HasSubstr("the machine is Faulted"));
  EXPECT_TRUE(forces_.set(1, 0)) << "letting go is no fault";
}

}  // namespace
}  // namespace rmac::gateway
