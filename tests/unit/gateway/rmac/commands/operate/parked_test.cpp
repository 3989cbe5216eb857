#include <gmock/gmock.h>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;

class ParkedCommand : public CommandBench {
 protected:
  void park() {
    appliance_.answers("RMAC_CAM.GetParkedProgram", {{"mechanism", "Mill"},
                                                     {"moves", 4},
                                                     {"move_id", 17},
                                                     {"s_mm", 2.5},
                                                     {"pose", {1.0, 2.0, 3.0, 0.0, 0.6, 0.8}},
                                                     {"off_mm", 0.125}});
  }
};

TEST_F(ParkedCommand, SaysWhereTheProgramGoesOn) {
  park();
  EXPECT_EQ(run({"parked"}).out,
            "a program is parked on Mill: 4 moves to do, from 2.500 mm along move 17, at 1.0000, 2.0000, 3.0000 in the "
            "part frame; the tool is 0.1250 mm from there\n");
}

TEST_F(ParkedCommand, SaysThatNoneIsParked) {
  appliance_.answers("RMAC_CAM.GetParkedProgram", json::object());
  EXPECT_EQ(run({"parked"}).out, "no program is parked\n");
  const auto failed = run({"parked", "--back", "5"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: no program is parked, so there is no place to go back to\n");
}

TEST_F(ParkedCommand, GoesBackFromAboveAlongTheTool) {
  park();
  ASSERT_EQ(run({"parked", "--back", "10"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.MoveToXYZ"),
              ElementsAre(json{{"MoveID", 1}, {"x", 1.0}, {"y", 8.0}, {"z", 11.0}, {"Speed", 20.0}},
                          json{{"MoveID", 2}, {"x", 1.0}, {"y", 2.0}, {"z", 3.0}, {"Speed", 20.0}}));
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.GetParkedProgram", kAcquireAuthority, "subscribe",
                                                "RMAC_CAM.CycleStart", "RMAC_CAM.MoveToXYZ", "RMAC_CAM.MoveToXYZ",
                                                "RMAC_CAM.GetState", kReleaseAuthority, "RMAC_CAM.GetParkedProgram"));
}

TEST_F(ParkedCommand, FailsWhenSomebodyStopsTheWayBack) {
  park();
  appliance_.answers("RMAC_CAM.GetState", state({{"moving", true}}));
  appliance_.handles("RMAC_CAM.MoveToXYZ", [&](const json&) {
    appliance_.push_event(gateway::Event::Kind::Stopped, {{"message", "stopped by the panel"}});
    return gateway::Answer(true);
  });
  EXPECT_EQ(run({"parked", "--back", "1"}).err, "rmac: stopped by the panel\n");
}

TEST_F(ParkedCommand, TakesAHeightWithinTenMetres) {
  EXPECT_EQ(run({"parked", "--back", "-0.1"}).exit_code, 2);
  EXPECT_EQ(run({"parked", "--back", "10000.1"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
