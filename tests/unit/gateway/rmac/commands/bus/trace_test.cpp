// `rmac bus trace` of files; what it hears on a bus is tried on the virtual bench (tests/bench).
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "places.hpp"
#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using testing::HasSubstr;
using testing::Not;

class BusTrace : public CommandBench {
 protected:
  Outcome trace(const std::string& text, std::vector<std::string> words = {}) {
    const std::string file = testing::TempDir() + "rmac-trace-test.log";
    std::ofstream(file) << text;
    words.insert(words.begin(), {"bus", "trace", "--file", file});
    Outcome outcome = run(words);
    std::remove(file.c_str());
    return outcome;
  }
};

constexpr const char* kLog =
    "(1436509052.249713) can0 080#\n"
    "(1436509052.250000) can0 181#3702391B0000\n"
    "(1436509052.250100) can1 702#05\n"
    "(1436509052.250200) can0 583#8041600000000206\n";

TEST_F(BusTrace, TellsEachFrameBehindItsLine) {
  const Outcome told = trace(kLog);
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_EQ(told.err, "");
  EXPECT_EQ(told.out,
            "(1436509052.249713) can0 080#  SYNC\n"
            "(1436509052.250000) can0 181#3702391B0000  TPDO1 node 1: 6 bytes, by a mapping that is not known\n"
            "(1436509052.250100) can1 702#05  heartbeat node 2: operational\n"
            "(1436509052.250200) can0 583#8041600000000206  SDO from node 3: abort 6041h:00 Statusword: object does "
            "not exist in the object dictionary (06020000h)\n");
  EXPECT_EQ(trace(told.out).out, told.out) << "what it tells can be read again";
}

TEST_F(BusTrace, TakesPdosApartByTheMachine) {
  const std::string machine = std::string(RMAC_SOURCE_DIR) + "/drivers/mill/5-axis/TarusXYZCA";
  EXPECT_THAT(trace(kLog, {"--machine", machine, "can0"}).out, HasSubstr("Statusword 0237h (operation enabled)"));
  const Outcome failed = trace(kLog, {"--machine", machine, "can7"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("has no CAN bus can7"));
}

TEST_F(BusTrace, ShowsWhatIsAskedFor) {
  EXPECT_THAT(trace(kLog, {"can1"}).out, Not(HasSubstr("can0")));
  EXPECT_EQ(trace(kLog, {"--no-cyclic"}).out.find("(1436509052.250100)"), 0U);
  const Outcome node = trace(kLog, {"--node", "2"});
  EXPECT_THAT(node.out, HasSubstr("SYNC"));
  EXPECT_THAT(node.out, HasSubstr("heartbeat node 2"));
  EXPECT_THAT(node.out, Not(HasSubstr("node 3")));
  for (const char* wrong : {"0", "128", "x"}) EXPECT_EQ(trace(kLog, {"--node", wrong}).exit_code, 2);
}

TEST_F(BusTrace, PrintsALineOfJsonAFrame) {
  std::istringstream lines(trace(kLog, {"--json", "can0"}).out);
  std::vector<nlohmann::json> frames;
  for (std::string line; std::getline(lines, line);) frames.push_back(nlohmann::json::parse(line));
  ASSERT_EQ(frames.size(), 3U);
  EXPECT_EQ(frames[0]["kind"], "sync");
  EXPECT_EQ(frames[1]["data"].size(), 6U);
  EXPECT_EQ(frames[2]["abort_code"], 0x06020000);
  EXPECT_EQ(frames[2]["node"], 3);
}

TEST_F(BusTrace, SaysWhereAFileHoldsSomethingElse) {
  const Outcome told = trace(std::string(kLog) + "\r\nrubbish\n(1436509052.3) can0 18");
  EXPECT_EQ(told.exit_code, 0);
  EXPECT_THAT(told.err, HasSubstr("rmac-trace-test.log:6: no whole frame of candump's; 2 lines are passed over"));
}

TEST_F(BusTrace, FailsWhereThereIsNothingToSee) {
  for (const char* text : {"", "\n\n", "rubbish\n"}) {
    const Outcome failed = trace(text);
    EXPECT_EQ(failed.exit_code, 1) << text;
    EXPECT_THAT(failed.err, HasSubstr("there is no frame in it")) << text;
  }
  const Outcome failed = trace(kLog, {"can7"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_THAT(failed.err, HasSubstr("there is no frame of can7 in it, but of can0, can1"));
  EXPECT_THAT(run({"bus", "trace", "--file", "/no/such/file"}).err,
              HasSubstr("/no/such/file: the file cannot be read"));
  EXPECT_EQ(run({"bus", "trace", "--file", testing::TempDir()}).exit_code, 1);
  EXPECT_THAT(run({"bus", "trace"}).err, HasSubstr("name the interface"));
}

TEST_F(BusTrace, ListensToABusWithoutAppliance) {
  EXPECT_THAT(run_at("/nonexistent/socket", {"bus", "trace", "nocan0", "--seconds", "1"}).err, HasSubstr("nocan0"));
  EXPECT_EQ(run({"bus", "trace", "--file", "x", "--record", "y"}).exit_code, 2);
  EXPECT_EQ(run({"bus", "trace", "nocan0", "--seconds", "0"}).exit_code, 2);
}

}  // namespace
}  // namespace rmac::cli
