#include "gateway/rmac/commands/command_line.hpp"

#include <gmock/gmock.h>

#include <regex>

#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

class CommandLineTest : public CommandBench {
 protected:
  /// Commands that the help of a command lists, in order.
  std::vector<std::string> listed(std::vector<std::string> words) {
    words.emplace_back("--help");
    const std::string help = run(words).out;
    const std::string commands = help.substr(std::min(help.size(), help.find("Subcommands:")));
    const std::regex line("\n  (\\S+)");
    std::vector<std::string> names;
    for (std::sregex_iterator at(commands.begin(), commands.end(), line), end; at != end; ++at) {
      names.push_back((*at)[1]);
    }
    return names;
  }
};

TEST_F(CommandLineTest, ListsItsCommandsInAnOrderThatAPersonLearns) {
  EXPECT_THAT(listed({}),
              ElementsAre("machines", "show", "load", "unload", "run", "status", "cycles", "events", "jog", "home",
                          "hold", "resume", "stop", "reset", "parked", "override", "tools", "confirm", "measure",
                          "qualify", "trace", "tune", "measure-following", "simulate", "import", "verify", "bus"));
  EXPECT_THAT(listed({"bus"}), ElementsAre("lss", "load", "scan", "sdo", "state", "store", "restore", "trace", "move"));
  EXPECT_THAT(listed({"bus", "lss"}), ElementsAre("scan", "assign", "bit-rate"));
  EXPECT_THAT(listed({"tools"}), ElementsAre("list", "set", "remove"));
  EXPECT_THAT(listed({"trace"}), ElementsAre("list", "record", "export", "plot"));
}

TEST_F(CommandLineTest, TellsWrongWordsFromFailures) {
  appliance_.refuses("RMAC_CAM.FeedHold", -32001, "nothing moves");
  EXPECT_EQ(run({"stop"}).exit_code, kExitDone);
  EXPECT_EQ(run({"--help"}).exit_code, kExitDone);
  EXPECT_EQ(run({"hold"}).exit_code, kExitFailed);
  EXPECT_EQ(run({"hold", "--now"}).exit_code, kExitUsage);
}

TEST_F(CommandLineTest, RefusesAnEmptyWordWhereATextIsToStand) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"simulate", "a.rmac", "--machine", "DMACXYZ", "--view", ""},
        {"simulate", "a.rmac", "--machine", ""},
        {"simulate", ""},
        {"load", ""},
        {"run", "a.rmac", "--record", ""}}) {
    const auto refused = run(words);
    EXPECT_EQ(refused.exit_code, kExitUsage) << words[0];
    EXPECT_THAT(refused.err, HasSubstr("is empty"));
  }
}

TEST_F(CommandLineTest, TellsAFailureInOneLine) {
  appliance_.refuses("RMAC_CAM.FeedHold", -32001, "nothing\nmoves\x1b[2J\n");
  EXPECT_EQ(run({"hold"}).err, "rmac: nothing?moves?[2J\n");
}

TEST_F(CommandLineTest, NamesTheWordThatIsNoCommand) {
  const auto refused = run({"holt"});
  EXPECT_EQ(refused.exit_code, kExitUsage);
  EXPECT_EQ(refused.err, "rmac: there is no holt; rmac --help lists what there is\n");
}

TEST_F(CommandLineTest, AsksNothingOfTheApplianceForWordsThatAreWrong) {
  EXPECT_EQ(run({"override", "250"}).exit_code, kExitUsage);
  EXPECT_EQ(run({"stop", "hold"}).exit_code, kExitUsage);
  EXPECT_THAT(appliance_.methods(), IsEmpty());
}

TEST_F(CommandLineTest, TakesTheSharedOptionsBehindTheCommandToo) {
  appliance_.answers("RMAC_CAM.GetParkedProgram", nlohmann::json::object());
  EXPECT_EQ(run({"parked", "--json"}).out, "{}\n");
  EXPECT_EQ(run({"--json", "parked"}).out, "{}\n");
}

TEST_F(CommandLineTest, NeedsNoApplianceForACommandThatAsksNoneForAnything) {
  const auto refused = run_at("/nonexistent/socket", {"simulate", "/nonexistent.rmac"});
  EXPECT_EQ(refused.exit_code, kExitFailed);
  EXPECT_EQ(refused.err, "rmac: /nonexistent.rmac: cannot be read: No such file or directory\n");
}

TEST_F(CommandLineTest, SaysWhereItLookedForAnAppliance) {
  const auto refused = run_at("/nonexistent/socket", {"stop"});
  EXPECT_EQ(refused.exit_code, kExitFailed);
  EXPECT_THAT(refused.err, HasSubstr("no appliance answers at /nonexistent/socket"));
}

TEST_F(CommandLineTest, TakesFiniteNumbersAlone) {
  for (const char* word : {"nan", "inf", "-inf"}) {
    const auto refused = run({"jog", "--joint", "0", "--distance", word});
    EXPECT_EQ(refused.exit_code, kExitUsage) << word;
    EXPECT_THAT(refused.err, HasSubstr("is no finite number")) << word;
  }
}

}  // namespace
}  // namespace rmac::cli
