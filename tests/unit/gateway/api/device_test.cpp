// Record set, device getters and setters, configuration.
#include <gtest/gtest.h>

#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using nlohmann::json;
using testing::_;
using testing::HasSubstr;
using testing::Return;

TEST(DriverManagerApi, ReadsTheRowUnderTheCursor) {
  Api api;
  EXPECT_TRUE(api.call("DeviceDriverManager.Machine_GetMechanismName").contains("error")) << "closed";
  EXPECT_EQ(api.result("DeviceDriverManager.OpenDeviceDriverDatabase"), true);
  EXPECT_EQ(api.result("DeviceDriverManager.GetTotalNumberOfRecords"), 2);
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismName"), "A");
  EXPECT_TRUE(api.result("DeviceDriverManager.OnNextRecord").is_null());
  EXPECT_EQ(api.result("DeviceDriverManager.GetDatabaseRecordSetColumns"), true);
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismName"), "B");
  EXPECT_TRUE(api.call("DeviceDriverManager.OnNextRecord").contains("error"));
  EXPECT_TRUE(api.result("DeviceDriverManager.OnFirstRecord").is_null());
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismID"), 1);
  EXPECT_EQ(api.result("DeviceDriverManager.SearchDatabaseRecordSet", R"(["SELECT 1"])"), 1);
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismName"), "SELECT 1");
  EXPECT_EQ(api.result("DeviceDriverManager.CloseDeviceDriverDatabase"), true);
  EXPECT_TRUE(api.call("DeviceDriverManager.Machine_GetMechanismName").contains("error"));
}

TEST(DriverManagerApi, GivesVersionAsNumberAndVolumeAsText) {
  Api api;
  EXPECT_EQ(api.result("DeviceDriverManager.OpenDeviceDriverDatabase"), true);
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismDeviceDriverVersion"), 10203);
  EXPECT_EQ(api.result("DeviceDriverManager.Machine_GetMechanismWorkingVolume"), "100.5x100.5x100.5");
}

TEST(DeviceApi, LoadsByNameAndSaysWhatThereIs) {
  Api api;
  api.machine.device_fake.device.reset();
  EXPECT_THAT(api.refusal("Device.Machine_GetMechanismName", "{}", -32016), HasSubstr("Device.Load"));
  EXPECT_THAT(api.refusal("Device.Load", R"({"Name":"Mill"})", -32014), HasSubstr("there is Fake"));
  EXPECT_EQ(api.result("Device.Load", R"({"Name":"Fake","Virtual":true})"), true);
  EXPECT_TRUE(api.machine.device_fake.is_virtual);
  EXPECT_EQ(api.result("Device.Load", R"({"Name":"Fake"})"), true);
  EXPECT_FALSE(api.machine.device_fake.is_virtual);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismName"), "Fake");
  EXPECT_EQ(api.result("Device.Unload"), true);
  EXPECT_TRUE(api.call("Device.OpenDeviceDatabase").contains("error"));
}

TEST(DeviceApi, ReadsNothingOnceItsDatabaseIsClosed) {
  Api api;
  EXPECT_EQ(api.result("Device.CloseDeviceDatabase"), true);
  for (const char* reader : {"Device.Machine_GetMechanismName", "Device.Machine_GetMechanismMaxFeedrate",
                             "Device.GetDatabaseRecordSetMechanismColumns", "Device.CloseDeviceDatabase"}) {
    EXPECT_THAT(api.refusal(reader, "{}", -32017), HasSubstr("Device.OpenDeviceDatabase")) << reader;
  }
  EXPECT_THAT(api.refusal("Device.Machine_GetMechanismJntMaxLimit", "[0]", -32017),
              HasSubstr("Device.OpenDeviceDatabase"));
  EXPECT_EQ(api.result("Device.OpenDeviceDatabase"), true);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismName"), "Fake");
}

TEST(DeviceApi, ReadsJointsAndHeldJointsByNumber) {
  Api api;
  EXPECT_EQ(api.result("Device.Machine_GetMechanismNumberOfJoints"), 2);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismJntTypes", "[0]"), 1);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismJntTypes", "[1]"), 0);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismJntMaxJerk", "[1]"), 5000.0);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismJntMaxLimit", "[2]"), 7.0);
  EXPECT_EQ(api.result("Device.Machine_GetMechanismJntServoControlLaw", "[0]"), "FakeLaw");
  EXPECT_THAT(api.refusal("Device.Machine_GetMechanismJntMaxLimit", "[3]", -32014), HasSubstr("joints 0 to 2"));
  EXPECT_EQ(api.result("Device.Machine_GetMechanismSpindleHorsePower"), 2.5);
}

TEST(DeviceApi, SettersChangeWhatConfigureThenPutsIn) {
  Api api;
  EXPECT_TRUE(api.result("Device.Machine_SetMechanismJntMaxSpeed", "[1, 45]").is_null());
  EXPECT_TRUE(api.result("Device.Machine_SetMechanismJntMinLimit", "[0, -5]").is_null());
  EXPECT_TRUE(api.result("Device.Machine_SetMechanismMaxFeedrate", "[500]").is_null());
  EXPECT_TRUE(api.result("Device.Machine_SetMechanismJntTypes", R"([0, "DMAC_ROT_JNT"])").is_null());
  EXPECT_CALL(api.machine.device_fake, configure_motion_planner()).WillOnce([&]() -> Expected<> {
    const sdk::DeviceObject& wanted = *api.machine.device_fake.device;
    EXPECT_EQ(wanted.joints[1].limits.max_speed, 45);
    EXPECT_EQ(wanted.joints[0].limits.min, -5);
    EXPECT_EQ(wanted.joints[0].limits.type, JointType::Rotary);
    EXPECT_EQ(wanted.max_feedrate_mm_min, 500);
    return {};
  });
  EXPECT_EQ(api.result("Device.Machine_ConfigureMotionPlanner"), true);
}

TEST(ConfigApi, PassesLimitsGainsAndModulesToTheDraft) {
  Api api;
  auto& config = api.machine.config_mock;
  sdk::DeviceObject draft;
  draft.actuator_map = {"Map", {{"pitch_mm", {5}}}, {}};
  ON_CALL(config, draft()).WillByDefault(testing::ReturnRef(draft));
  EXPECT_CALL(config.joints_mock, set_maximum_jerk(1, 4000)).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_Config.SetMechanismJointMaximumJerk", "[1, 4000]").is_null());
  EXPECT_CALL(config.loops_mock, set_gains(0, testing::ElementsAre(1, 2, 3))).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_Config.SetMechanismJointServoControlGains", "[0, [1,2,3]]").is_null());
  EXPECT_CALL(config.joints_mock, set_limit_type(0, JointLimitType::InfinitePositive)).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_Config.SetMechanismJointLimitType", "[0, 2]").is_null());
  // Naming the module that the draft has keeps its parameters; another one starts without.
  EXPECT_CALL(config.mechanism_mock, set_actuator_map(testing::Field(&sdk::ModuleChoice::numbers, testing::SizeIs(1))))
      .WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_Config.SetMechanismActuatorMap", R"(["Map"])").is_null());
  EXPECT_CALL(config.mechanism_mock, set_actuator_map(testing::Field(&sdk::ModuleChoice::numbers, testing::IsEmpty())))
      .WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_Config.SetMechanismActuatorMap", R"(["Other"])").is_null());
  EXPECT_CALL(config, apply()).WillOnce(Return(failure(MinorCode::InvalidParameterValue, "joint 0: min over max")));
  EXPECT_EQ(api.refusal("RMAC_Config.Apply", "{}", -32014), "joint 0: min over max");
}

TEST(CamApi, ButtonsDoWhatTheirFunctionsDo) {
  Api api;
  auto& cam = api.machine.cam_mock;
  EXPECT_CALL(cam.cycle_mock, start(sdk::CycleMode::Automatic)).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_CAM.SetCycleStartStatus", "[true]").is_null());
  EXPECT_TRUE(api.result("RMAC_CAM.SetCycleStartStatus", "[false]").is_null());
  EXPECT_CALL(cam.cycle_mock, stop()).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_CAM.SetCycleStopStatus", "[true]").is_null());
  EXPECT_TRUE(api.result("RMAC_CAM.SetCycleStopStatus", "[false]").is_null());
}

TEST(CamApi, AnimationStreamsJointsToItsCaller) {
  Api api;
  EXPECT_TRUE(api.result("RMAC_CAM.SetAnimation", "[true]").is_null());
  EXPECT_TRUE(api.session.animation);
  EXPECT_TRUE(api.result("RMAC_CAM.SetAnimation", "[false]").is_null());
  EXPECT_FALSE(api.session.animation);
}

TEST(CamApi, JogsByDistanceOrAtAVelocity) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.positioning_mock, jog_joint(1, -2.5)).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.positioning_mock, jog_joint_at(2, 4)).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.positioning_mock, jog_path(sdk::JogDirection{{1, 0, 0}, false}, 3))
      .WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.positioning_mock, jog_path_at(sdk::JogDirection{{0, 0, 1}, true}, -5))
      .WillOnce(Return(Expected<>{}));
  EXPECT_EQ(api.result("RMAC_CAM.JogJoint", R"({"JntNum":1,"Distance":-2.5})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.JogJoint", R"({"JntNum":2,"Velocity":4})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.JogPath", R"({"Direction":[1,0,0],"Distance":3})"), true);
  EXPECT_EQ(api.result("RMAC_CAM.JogPath", R"({"Direction":[0,0,1],"Velocity":-5,"InToolFrame":true})"), true);
  api.refusal("RMAC_CAM.JogJoint", R"({"JntNum":1})", -32013);
  api.refusal("RMAC_CAM.JogJoint", R"({"JntNum":1,"Distance":1,"Velocity":1})", -32013);
  api.refusal("RMAC_CAM.JogPath", R"({"Distance":1})", -32602);
}

TEST(CamApi, RetracesAndAnswersTheWay) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, retrace(7)).WillOnce(Return(Expected<double>(4.5)));
  EXPECT_EQ(api.result("RMAC_CAM.FeedRetrace", R"({"Distance":7})"), 4.5);
  api.refusal("RMAC_CAM.FeedRetrace", R"({"Distance":0})", -32602);
}

TEST(CamApi, StateTellsMechanismJointsAndStatus) {
  Api api;
  api.machine.now.joint_count = 2;
  api.machine.now.joint_count_with_held = 3;
  api.machine.now.position = {1, 2, 3};
  api.machine.now.position_set = {1.5, 2.5, 3.5};
  api.machine.now.feed_actual_mm_s = 10;
  const json state = api.result("RMAC_CAM.GetState");
  EXPECT_EQ(state["mechanism"], "Fake");
  EXPECT_EQ(state["joints"], json::parse("[1.0,2.0]"));
  EXPECT_EQ(state["joints_set"], json::parse("[1.5,2.5]"));
  EXPECT_EQ(state["held_joints"], json::parse("[3.0]"));
  EXPECT_EQ(state["feed_actual_mm_min"], 600.0);
  EXPECT_EQ(state["state"], "Idle");
  EXPECT_EQ(state["spindle_rpm"].size(), 1U);
}

TEST(CamApi, StateShowsWhereAMoveEndedThatIsGoneFromTheQueue) {
  Api api;
  api.machine.now.joint_count = api.machine.now.joint_count_with_held = 1;
  api.machine.now.moving = true;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, moves_left()).WillRepeatedly([&api] {
    api.machine.now.moving = false;  // a cycle went by
    api.machine.now.position = {5};
    return 0;
  });
  const json state = api.result("RMAC_CAM.GetState");
  EXPECT_EQ(state["moves_in_buffer"], 0);
  EXPECT_EQ(state["moving"], false);
  EXPECT_EQ(state["joints"], json::parse("[5.0]"));
}

TEST(CamApi, StateIsTheControllersNotTheLastSamplesNorWhatWasSetLast) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, set_feed_override(50)).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(api.machine.cam_mock.cycle_mock, start(_)).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(api.result("RMAC_CAM.SetFeedOverride", "[50]").is_null());
  EXPECT_EQ(api.result("RMAC_CAM.CycleStart", "[0]"), true);
  api.machine.now.state = CycleState::Idle;
  api.machine.cycle = {CycleState::Running, "AUTOMATIC", 130};
  const json state = api.result("RMAC_CAM.GetState");
  EXPECT_EQ(state["state"], "Running");
  EXPECT_EQ(state["mode"], "AUTOMATIC");
  EXPECT_EQ(state["override_percent"], 130);
}

TEST(DriverManagerApi, RescanTellsWhatIsLeftOutAndWhy) {
  Api api;
  const json report = api.result("DeviceDriverManager.Rescan");
  EXPECT_EQ(report["mechanisms"], 6);
  ASSERT_EQ(report["problems"].size(), 1U);
  EXPECT_EQ(report["problems"][0]["file"], "mill/broken/device.json");
  EXPECT_EQ(report["problems"][0]["message"], "mill/broken/device.json: /Type is 5");
}

}  // namespace
}  // namespace rmac::gateway
