#include <gmock/gmock.h>

#include <cmath>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

/// A probe of radius 1.5 whose tip is 0.2 mm farther in X than it is taken to be; the sphere of radius 10 is at 5,
/// 6, 7.
class QualifyCommand : public CommandBench {
 protected:
  QualifyCommand() {
    appliance_.answers("RMAC_CAM.GetTools", {{"Tools",
                                              {{{"ToolNumber", 9},
                                                {"Name", "probe"},
                                                {"Length", 60.0},
                                                {"Radius", 1.4},
                                                {"Frame", {{"p", {0.0, 0.0, 0.0}}, {"q", {1.0, 0.0, 0.0, 0.0}}}}}}},
                                             {"Mounted", 9},
                                             {"Wanted", nullptr},
                                             {"Prompt", ""}});
    appliance_.answers("RMAC_CAM.GetPartFrame", {{"p", {0.0, 0.0, 0.0}}, {"q", {1.0, 0.0, 0.0, 0.0}}});
    appliance_.answers("Device.Machine_GetMechanismJntTypes", 1);
    appliance_.handles("RMAC_CAM.MoveToXYZ", [this](const json& params) {
      done(params);
      return gateway::Answer(true);
    });
    appliance_.handles("RMAC_CAM.AutoMeasure", [this](const json& params) {
      // Towards the nominal place the machine is told to be where its tip, 0.2 mm off, meets the sphere.
      double way[3];
      const double nominal[3]{params.at("x"), params.at("y"), params.at("z")};
      const double centre[3]{5, 6, 7};
      for (int i = 0; i < 3; ++i) way[i] = (nominal[i] - centre[i]) / 11.4;
      // |t·way + offset| = 11.5 along the way of the approach.
      const double along = 0.2 * way[0];
      const double t = -along + std::sqrt(along * along + 11.5 * 11.5 - 0.2 * 0.2);
      json pose{0, 0, 0, 0, 0, 1};
      for (std::size_t i = 0; i < 3; ++i) pose[i] = centre[i] + t * way[i];
      appliance_.push_event(gateway::Event::Kind::Hit, {{"pose", pose}});
      done(params);
      return gateway::Answer(true);
    });
  }
  void done(const json& params) {
    appliance_.push_event(gateway::Event::Kind::MoveDone, {{"move_id", params.at("MoveID")}});
  }
};

TEST_F(QualifyCommand, FindsRadiusAndPlaceOfTheTip) {
  const auto shown = run({"--json", "qualify", "--sphere", "5", "6", "7", "10"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const json found = json::parse(shown.out);
  EXPECT_NEAR(found.at("tip_radius_mm").get<double>(), 1.5, 1e-9);
  EXPECT_NEAR(found.at("offset_mm")[0].get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(found.at("offset_mm")[1].get<double>(), 0, 1e-9);
  EXPECT_EQ(found.at("points"), 13);
  EXPECT_EQ(found.at("tool"), 9);
  EXPECT_EQ(found.at("applied"), false);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetTool"), IsEmpty());
  EXPECT_EQ(appliance_.methods().front(), kAcquireAuthority);
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(QualifyCommand, CorrectsTheToolWhenAskedTo) {
  const auto shown = run({"qualify", "--sphere", "5", "6", "7", "10", "--apply"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("tool 9 is corrected by it"));
  const auto set = appliance_.params_of("RMAC_CAM.SetTool");
  ASSERT_EQ(set.size(), 1U);
  EXPECT_NEAR(set[0].at("Radius").get<double>(), 1.5, 1e-9);
  EXPECT_NEAR(set[0].at("Length").get<double>(), 60, 1e-9);
  EXPECT_NEAR(set[0].at("Frame").at("p")[0].get<double>(), 0.2, 1e-9);
}

TEST_F(QualifyCommand, CorrectsNothingWhileAJointIsTurned) {
  appliance_.answers("Device.Machine_GetMechanismJntTypes", 0);
  appliance_.answers("RMAC_CAM.GetState", state({{"joints", {0.0, 0.02, 0.0}}}));
  const auto failed = run({"qualify", "--sphere", "5", "6", "7", "10", "--apply"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("joint 1 stands at 0.0200 degrees"));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.AutoMeasure"), IsEmpty());
}

TEST_F(QualifyCommand, NeedsAProbeThatItKnows) {
  appliance_.answers("RMAC_CAM.GetTools", {{"Tools", json::array()}, {"Mounted", 0}, {"Wanted", nullptr}});
  EXPECT_THAT(run({"qualify", "--sphere", "5", "6", "7", "10"}).err, HasSubstr("no tool of the tool table is in the"));
  EXPECT_EQ(run({"qualify", "--sphere", "5", "6", "7", "10", "--tip-radius", "1.4"}).exit_code, 0);
}

TEST_F(QualifyCommand, FailsWhereNothingIsHit) {
  appliance_.handles("RMAC_CAM.AutoMeasure", [this](const json& params) {
    done(params);
    return gateway::Answer(true);
  });
  EXPECT_EQ(run({"qualify", "--sphere", "5", "6", "7", "10"}).err, "rmac: a point was measured, and no hit was told\n");
}

TEST_F(QualifyCommand, TakesASphereAndBoundsOfItsWays) {
  EXPECT_EQ(run({"qualify"}).exit_code, 2);
  EXPECT_EQ(run({"qualify", "--sphere", "1", "2", "3"}).exit_code, 2);
  for (const auto& [option, value] :
       {std::pair{"--tip-radius", "100.1"}, {"--clearance", "0.05"}, {"--speed", "1001"}}) {
    EXPECT_EQ(run({"qualify", "--sphere", "5", "6", "7", "10", option, value}).exit_code, 2) << option;
  }
}

}  // namespace
}  // namespace rmac::cli
