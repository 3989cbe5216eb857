#include <gmock/gmock.h>

#include "gateway/rmac/wire/authority.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

const json kCutter{{"ToolNumber", 3},      {"Name", "cutter"},
                   {"Length", 50.25},      {"Radius", 4.0},
                   {"MaxRPM", 12000.0},    {"MaxTorque", 0.0},
                   {"NeedsSpindle", true}, {"Frame", {{"p", {0.0, 0.0, 0.0}}, {"q", {1.0, 0.0, 0.0, 0.0}}}}};

class ToolsCommand : public CommandBench {
 protected:
  ToolsCommand() { has(3, json(), ""); }
  void has(const json& mounted, const json& wanted, const std::string& prompt) {
    appliance_.answers("RMAC_CAM.GetTools",
                       {{"Tools", {kCutter}}, {"Mounted", mounted}, {"Wanted", wanted}, {"Prompt", prompt}});
  }
};
using ConfirmCommand = ToolsCommand;

TEST_F(ToolsCommand, ListsTheTable) {
  const std::string table =
      "tool  name    length mm  radius mm  rpm at most  N·m at most  needs spindle  set off or turned\n"
      "   3  cutter      50.25          4        12000            -  yes            no\n"
      "\nspindle: tool 3\n";
  EXPECT_EQ(run({"tools"}).out, table);
  EXPECT_EQ(run({"tools", "list"}).out, table);
}

TEST_F(ToolsCommand, TellsAnEmptySpindleFromOneThatIsNotKnown) {
  has(0, json(), "");
  EXPECT_THAT(run({"tools"}).out, HasSubstr("spindle: empty\n"));
  has(json(), 4, "put tool 4 into the spindle");
  EXPECT_THAT(run({"tools"}).out, HasSubstr("spindle: not known: look, and say it with rmac confirm NUMBER\n"
                                            "to do: put tool 4 into the spindle\n"));
}

TEST_F(ToolsCommand, ChangesNothingOfAToolButWhatIsGiven) {
  ASSERT_EQ(run({"tools", "set", "3", "--radius", "3.9", "--needs-spindle", "false"}).exit_code, 0);
  json wanted = kCutter;
  wanted["Radius"] = 3.9;
  wanted["NeedsSpindle"] = false;
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetTool"), ElementsAre(wanted));
  EXPECT_THAT(appliance_.methods(),
              ElementsAre("RMAC_CAM.GetTools", kAcquireAuthority, "RMAC_CAM.SetTool", kReleaseAuthority));
}

TEST_F(ToolsCommand, AddsATool) {
  ASSERT_EQ(run({"tools", "set", "7", "--length", "80", "--name", "head", "--max-rpm", "5000", "--max-torque", "2",
                 "--frame", "1", "2", "3", "0", "1", "0", "0"})
                .exit_code,
            0);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.SetTool"),
              ElementsAre(json{{"ToolNumber", 7},
                               {"Length", 80.0},
                               {"Name", "head"},
                               {"MaxRPM", 5000.0},
                               {"MaxTorque", 2.0},
                               {"Frame", {{"p", {1.0, 2.0, 3.0}}, {"q", {0.0, 1.0, 0.0, 0.0}}}}}));
}

TEST_F(ToolsCommand, AddsNoToolWithoutALength) {
  const auto failed = run({"tools", "set", "7", "--radius", "1"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: tool 7 is new: give its --length\n");
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.GetTools")) << "the lease may be another's";
}

TEST_F(ToolsCommand, TakesAToolOut) {
  ASSERT_EQ(run({"tools", "remove", "3"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.RemoveTool"), ElementsAre(json{{"ToolNumber", 3}}));
  EXPECT_EQ(appliance_.methods().back(), kReleaseAuthority);
}

TEST_F(ToolsCommand, TakesNumbersOfTools) {
  for (const char* number : {"0", "10000", "x"}) {
    EXPECT_EQ(run({"tools", "set", number, "--length", "1"}).exit_code, 2) << number;
    EXPECT_EQ(run({"tools", "remove", number}).exit_code, 2) << number;
  }
  EXPECT_EQ(run({"tools", "set", "3", "--frame", "1", "2", "3"}).exit_code, 2);
}

TEST_F(ConfirmCommand, SaysThatTheToolThatIsWantedIsThere) {
  has(json(), 4, "put tool 4 into the spindle");
  ASSERT_EQ(run({"confirm"}).exit_code, 0);
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.ConfirmToolChange"), ElementsAre(json{{"ToolNumber", 4}}));
}

TEST_F(ConfirmCommand, SaysWhichToolIsThereWithoutAskingWhatIsWanted) {
  ASSERT_EQ(run({"confirm", "0"}).exit_code, 0);
  EXPECT_THAT(appliance_.methods(), ElementsAre("RMAC_CAM.ConfirmToolChange"));
  EXPECT_THAT(appliance_.params_of("RMAC_CAM.ConfirmToolChange"), ElementsAre(json{{"ToolNumber", 0}}));
}

TEST_F(ConfirmCommand, NeedsANumberWhereNoneIsWanted) {
  const auto failed = run({"confirm"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("no tool change is under way"));
  EXPECT_EQ(run({"confirm", "-1"}).exit_code, 2);
  EXPECT_EQ(run({"confirm", "10000"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
