#include <gmock/gmock.h>

#include <fstream>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;

/// A box of three faces that lies 0.1 mm too high in Z, and a probe of radius 1 that a plan names.
class MeasureCommand : public CommandBench {
 protected:
  MeasureCommand() {
    const auto point = [](double x, double y, double z, const json& normal) {
      return json{{"Point", {x, y, z}}, {"Normal", normal}};
    };
    const json up{0, 0, 2}, left{-1, 0, 0}, front{0, -1, 0};
    plan_ = {{"SafeHeight", 30},
             {"TipRadius", 1},
             {"Features",
              {{{"Name", "top"}, {"Points", {point(10, 10, 0, up), point(50, 10, 0, up), point(30, 50, 0, up)}}},
               {{"Name", "left"}, {"Points", {point(0, 10, -5, left), point(0, 50, -5, left)}}},
               {{"Name", "front"}, {"Points", {point(30, 0, -5, front)}}}}}};
    appliance_.answers("RMAC_CAM.GetPartFrame", {{"p", {0.0, 0.0, 0.0}}, {"q", {1.0, 0.0, 0.0, 0.0}}});
    appliance_.handles("RMAC_CAM.MoveToXYZ", [this](const json& params) {
      heights_.push_back(params.at("z"));
      done(params);
      return gateway::Answer(true);
    });
    appliance_.handles("RMAC_CAM.AutoMeasure", [this](const json& params) {
      const double z = params.at("z");
      const bool top = z > 0;
      appliance_.push_event(gateway::Event::Kind::Hit,
                            {{"pose", {params.at("x"), params.at("y"), top ? z + 0.1 : z, 0, 0, 1}}});
      done(params);
      return gateway::Answer(true);
    });
  }
  void done(const json& params) {
    appliance_.push_event(gateway::Event::Kind::MoveDone, {{"move_id", params.at("MoveID")}});
  }
  Outcome measure(std::vector<std::string> words = {}) {
    const std::string file = testing::TempDir() + "measure_test.json";
    std::ofstream(file) << plan_;
    words.insert(words.begin(), {"measure", file});
    return run(words);
  }

  json plan_;
  std::vector<double> heights_;  ///< to which the probe went; the fake's thread, until the command is over
};

TEST_F(MeasureCommand, TellsHowFarThePartIsOffAndSetsNothing) {
  const auto shown = measure({"--json"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const json found = json::parse(shown.out);
  EXPECT_NEAR(found.at("part_off").at("p")[2].get<double>(), 0.1, 1e-6);
  EXPECT_NEAR(found.at("features")[0].at("before").at("mean_mm").get<double>(), 0.1, 1e-9);
  EXPECT_NEAR(found.at("features")[0].at("after").at("mean_mm").get<double>(), 0, 1e-6);
  EXPECT_EQ(found.at("points").size(), 6U);
  EXPECT_EQ(found.at("applied"), false);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetPartFrame"), IsEmpty());
}

TEST_F(MeasureCommand, SetsThePartFrameWhenAskedTo) {
  const auto shown = measure({"--apply"});
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("its frame is in force"));
  const auto set = appliance_.params_of("RMAC_CAM.SetPartFrame");
  ASSERT_EQ(set.size(), 1U);
  EXPECT_NEAR(set[0].at("PartFrame").at("p")[2].get<double>(), 0.1, 1e-6);
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(MeasureCommand, GoesOverTheSafeHeightFromPointToPoint) {
  ASSERT_EQ(measure().exit_code, 0);
  // Up, across, down beside the point: three ways a point, and up at the end.
  ASSERT_EQ(heights_.size(), 6 * 3 + 1U);
  for (std::size_t point = 0; point < 6; ++point) {
    EXPECT_DOUBLE_EQ(heights_[3 * point], 30);
    EXPECT_DOUBLE_EQ(heights_[3 * point + 1], 30);
  }
  EXPECT_DOUBLE_EQ(heights_.back(), 30);
}

TEST_F(MeasureCommand, TellsWhyItCannotAlignAndAppliesNothingThen) {
  plan_["Features"] = json::array({plan_["Features"][0]});
  const auto shown = measure();
  EXPECT_EQ(shown.exit_code, 0) << shown.err;
  EXPECT_THAT(shown.out, HasSubstr("\nnot aligned: "));
  const auto failed = measure({"--apply"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("nothing is applied: "));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetPartFrame"), IsEmpty());
}

TEST_F(MeasureCommand, StopsAtWhatStopsTheMachine) {
  appliance_.handles("RMAC_CAM.AutoMeasure", [this](const json&) {
    appliance_.push_event(gateway::Event::Kind::Stopped, {{"message", "nothing was hit on the way"}});
    return gateway::Answer(true);
  });
  EXPECT_EQ(measure().err, "rmac: nothing was hit on the way\n");
  EXPECT_EQ(appliance_.params_of("RMAC_CAM.AutoMeasure").size(), 1U);
}

TEST_F(MeasureCommand, MovesNothingForAPlanThatIsWrong) {
  plan_["Features"][0]["Points"][1]["Normal"] = {0, 0, 0};
  const auto failed = measure();
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("/Features/0/Points/1/Normal has no length"));
  plan_.erase("SafeHeight");
  EXPECT_THAT(measure().err, HasSubstr("SafeHeight"));
  EXPECT_THAT(appliance_.methods(), IsEmpty());
}

}  // namespace
}  // namespace rmac::cli
