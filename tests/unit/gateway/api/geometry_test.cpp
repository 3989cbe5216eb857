// Poses and curves on the wire.
#include <gtest/gtest.h>

#include <cmath>

#include "session.hpp"

namespace rmac::gateway {
namespace {

using fakes::Api;
using nlohmann::json;
using testing::_;
using testing::DoAll;
using testing::HasSubstr;
using testing::Return;
using testing::SaveArg;

/// What reached the machine of one move.
Geometry queued(const std::string& method, const std::string& params) {
  Api api;
  Geometry geometry;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, add(7, _)).WillOnce(DoAll(SaveArg<1>(&geometry), Return(Expected<>{})));
  EXPECT_EQ(api.result(method, params), true);
  return geometry;
}

std::string refused(const std::string& method, const std::string& params) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, add(_, _)).Times(0);
  return api.refusal(method, params, rpc_code::kInvalidParams);
}

TEST(Wire, ReadsALineWithAxisOrQuaternion) {
  const double half = std::sqrt(0.5);
  const Geometry geometry =
      queued("RMAC_CAM.MoveAlongLine", json{{"MoveID", 7},
                                            {"StartPoint", {{"p", {1, 2, 3}}, {"axis", {0, 0, 1}}}},
                                            {"EndPoint", {{"p", {4, 5, 6}}, {"q", {half, half, 0, 0}}}}}
                                           .dump());
  const auto& line = std::get<LineGeometry>(geometry);
  EXPECT_EQ(line.start.tip, (Vector{1, 2, 3}));
  EXPECT_EQ(line.start.axis, (Vector{0, 0, 1}));
  EXPECT_EQ(line.end.tip, (Vector{4, 5, 6}));
  // A quarter turn about x takes z to -y.
  EXPECT_NEAR(line.end.axis[0], 0, 1e-15);
  EXPECT_NEAR(line.end.axis[1], -1, 1e-15);
  EXPECT_NEAR(line.end.axis[2], 0, 1e-15);
}

TEST(Wire, ReadsAnArcAboutTheAxisOfItsCenter) {
  const auto arc = std::get<ArcGeometry>(queued("RMAC_CAM.MoveAlongArc",
                                                R"({"MoveID":7,"RotSign":"clockwise","Closed":true,
      "CenterPoint":{"p":[1,0,0],"axis":[0,1,0]},"StartPoint":{"p":[0,0,0],"axis":[0,0,1]},
      "EndPoint":{"p":[0,0,0],"axis":[0,0,1]}})"));
  EXPECT_EQ(arc.rotation, -1);
  EXPECT_TRUE(arc.closed);
  EXPECT_EQ(arc.center, (Vector{1, 0, 0}));
  EXPECT_EQ(arc.normal, (Vector{0, 1, 0}));
  EXPECT_EQ(arc.turns, 0);
}

TEST(Wire, ReadsTheTurnsOfAHelix) {
  const std::string helix = R"({"MoveID":7,"RotSign":"clockwise","Closed":false,
      "CenterPoint":{"p":[1,0,0],"axis":[0,0,1]},"StartPoint":{"p":[0,0,0],"axis":[0,0,1]},
      "EndPoint":{"p":[2,0,5],"axis":[0,0,1]},"Turns":)";
  const auto arc = std::get<ArcGeometry>(queued("RMAC_CAM.MoveAlongArc", helix + "3}"));
  EXPECT_EQ(arc.turns, 3);
  EXPECT_EQ(arc.end.tip, (Vector{2, 0, 5}));
  for (const char* wrong : {"-1", "1001", "1.5", "\"two\"", "1e300"}) {
    EXPECT_THAT(refused("RMAC_CAM.MoveAlongArc", helix + wrong + "}"), HasSubstr("Turns")) << wrong;
  }
}

TEST(Wire, ReadsAnArcThroughAPoint) {
  const auto arc = std::get<Arc3Geometry>(queued("RMAC_CAM.MoveAlongArc3",
                                                 R"({"MoveID":7,"ViaPoint":[1,1,0],
      "StartPoint":{"p":[0,0,0],"axis":[0,0,1]},"EndPoint":{"p":[2,0,0],"axis":[0,0,1]}})"));
  EXPECT_EQ(arc.via, (Vector{1, 1, 0}));
}

TEST(Wire, ReadsANurbsWithFlatKnotsAndWeights) {
  const auto nurbs = std::get<NurbsGeometry>(
      queued("RMAC_CAM.MoveAlongNurbs",
             R"([7, {"degree":2,"knots":[0,0,0,1,1,1],"points":[[0,0,0],[1,1,0],[2,0,0]],"weights":[1,0.5,1]}])"));
  EXPECT_EQ(nurbs.space, NurbsSpace::Tip);
  EXPECT_EQ(nurbs.curve.degree, 2);
  EXPECT_EQ(nurbs.curve.dimension, 3U);
  EXPECT_EQ(nurbs.curve.weights, (std::vector<double>{1, 0.5, 1}));
}

TEST(Wire, FlattensKnotsWithMultiplicities) {
  const auto nurbs = std::get<NurbsGeometry>(queued(
      "RMAC_CAM.MoveAlongNurbs",
      R"([7, {"degree":2,"knots":[0,0.5,1],"multiplicities":[3,1,3],"points":[[0,0,0],[1,1,0],[2,0,0],[3,0,0]]}])"));
  EXPECT_EQ(nurbs.curve.knots, (std::vector<double>{0, 0, 0, 0.5, 1, 1, 1}));
}

TEST(Wire, ReadsNurbsOfPosesAndOfJoints) {
  const auto pose = std::get<NurbsGeometry>(
      queued("RMAC_CAM.MoveAlongNurbsND",
             R"([7, {"space":"pose","degree":1,"knots":[0,0,1,1],"points":[[0,0,0,0,0,1],[1,0,0,0,0,1]]}])"));
  EXPECT_EQ(pose.space, NurbsSpace::Pose);
  EXPECT_EQ(pose.curve.dimension, 6U);
  const auto joint = std::get<NurbsGeometry>(queued(
      "RMAC_CAM.MoveAlongNurbsND", R"([7, {"space":"joint","degree":1,"knots":[0,0,1,1],"points":[[0,0],[1,0]]}])"));
  EXPECT_EQ(joint.space, NurbsSpace::Joint);
  EXPECT_EQ(joint.curve.dimension, 2U);
}

TEST(Wire, ReadsJointTargetsAsJointsOrAsAPose) {
  const auto target = std::get<JointTargetGeometry>(queued("RMAC_CAM.MoveToJointTarget", R"([7, {"joints":[1,2,3]}])"));
  EXPECT_EQ(target.joints, (std::vector<double>{1, 2, 3}));
  Api api;
  Geometry geometry;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, joints_at(_)).WillOnce(Return(std::vector<double>{4, 5}));
  EXPECT_CALL(api.machine.cam_mock.queue_mock, add(8, _)).WillOnce(DoAll(SaveArg<1>(&geometry), Return(Expected<>{})));
  EXPECT_EQ(api.result("RMAC_CAM.MoveToJointTarget", R"([8, {"p":[1,2,3],"q":[1,0,0,0]}])"), true);
  EXPECT_EQ(std::get<JointTargetGeometry>(geometry).joints, (std::vector<double>{4, 5}));
}

TEST(Wire, NamesThePlaceInsideABadCurve) {
  const auto message = [](const std::string& curve) { return refused("RMAC_CAM.MoveAlongNurbs", "[7," + curve + "]"); };
  EXPECT_EQ(message(R"({"degree":1,"knots":[0,0,1,"x"],"points":[[0,0,0],[1,0,0]]})"),
            "parameter \"Nurbs\" at .knots[3] is \"x\", expected a number");
  EXPECT_EQ(message(R"({"degree":1,"knots":[0,0,1,1],"points":[[0,0,0],[1,0]]})"),
            "parameter \"Nurbs\" at .points[1] is [1,0], expected 3 numbers");
  EXPECT_EQ(message(R"({"degree":0,"knots":[0,1],"points":[[0,0,0]]})"),
            "parameter \"Nurbs\" at .degree is 0, expected an integer 1 to 25");
  EXPECT_THAT(message(R"({"degree":1,"knots":[0,0,1,1]})"), HasSubstr("a member \"points\""));
  EXPECT_THAT(message(R"({"degree":1,"knots":[0,0,1,1],"points":[[0,0,0]],"colour":1})"), HasSubstr(".colour"));
  EXPECT_THAT(message(R"({"degree":1,"knots":[0,1],"multiplicities":[2],"points":[[0,0,0]]})"),
              HasSubstr("one integer for each of the 2 knots"));
  EXPECT_THAT(message(R"({"degree":1,"knots":[0,1],"multiplicities":[2,1000000000],"points":[[0,0,0]]})"),
              HasSubstr(".multiplicities[1]"));
}

TEST(Wire, RefusesFramesThatAreNone) {
  const auto message = [](const std::string& frame) {
    return refused("RMAC_CAM.MoveToPathTarget", "[7," + frame + "]");
  };
  EXPECT_THAT(message(R"({"p":[0,0,0]})"), HasSubstr("\"axis\": [i, j, k]"));
  EXPECT_THAT(message(R"({"p":[0,0],"axis":[0,0,1]})"), HasSubstr("three numbers"));
  EXPECT_THAT(message(R"({"p":[0,0,0],"axis":[0,0,2]})"), HasSubstr("the length of this one is 2"));
  EXPECT_THAT(message(R"({"p":[0,0,0],"q":[0,0,0,0]})"), HasSubstr("the length of this one is 0"));
  EXPECT_THAT(message(R"({"p":[0,0,0],"axis":[0,0,1],"q":[1,0,0,0]})"), HasSubstr("expected a frame"));
  EXPECT_THAT(message(R"({"p":[null,0,0],"axis":[0,0,1]})"), HasSubstr("three numbers"));
}

TEST(Wire, NeedsAWholeFrameForThePartFrame) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.frames_mock, set_part(_)).Times(0);
  api.refusal("RMAC_CAM.SetPartFrame", R"({"PartFrame":{"p":[0,0,0],"axis":[0,0,1]}})", rpc_code::kInvalidParams);
}

TEST(Wire, ReadsMasksAsIntegersAndAsHexadecimalTexts) {
  Api api;
  const auto minor_of = [&](const char* mask) {
    return api.call("RMAC_CAM.SendConditionChangedEvent",
                    std::string("[[0],1,") + mask + ",0]")["error"]["data"]["minorCode"];
  };
  EXPECT_TRUE(minor_of("9007199254740991").is_null());
  EXPECT_TRUE(minor_of("\"0xffffffffffffffff\"").is_null());
  for (const char* bad : {"-1", "9007199254740992", "\"0x\"", "\"0x11111111111111111\"", "\"12\"", "\"0xg\"", "1.5"}) {
    EXPECT_EQ(minor_of(bad), 14) << bad;
  }
}

TEST(Wire, SendsMovesOfTheDeviceThroughItsDriver) {
  Api api;
  EXPECT_CALL(api.machine.cam_mock.queue_mock, add(_, _)).Times(0);
  EXPECT_CALL(api.machine.device_fake, move(3, _)).WillOnce(Return(Expected<>{}));
  EXPECT_EQ(
      api.result("Device.Machine_MoveInNurbs", R"([3, {"degree":1,"knots":[0,0,1,1],"points":[[0,0,0],[1,0,0]]}])"),
      true);
}

}  // namespace
}  // namespace rmac::gateway
