#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "unit/gateway/rmac/command_bench.hpp"

namespace rmac::cli {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

class TraceCommand : public CommandBench {
 protected:
  TraceCommand() {
    appliance_.answers("FlightRecorder.List",
                       {{"records",
                         {{{"name", "r-1"}, {"mechanism", "Mill"}, {"cycle", 5}, {"message", "late"}},
                          {{"name", "r-2"}, {"mechanism", "Mill"}, {"cycle", 9}, {"message", "asked for"}}}}});
    // In two pieces, as a record that is longer than a line of the wire.
    appliance_.handles("FlightRecorder.Read", [](const json& params) {
      const bool first = params.at("Offset") == 0;
      return gateway::Answer(first ? json{{"text", "{\"record\":1}\nt_s,q"}, {"next_offset", 7}}
                                   : json{{"text", "0\n1,2\n"}, {"next_offset", nullptr}});
    });
  }
};

TEST_F(TraceCommand, ListsTheRecords) {
  const std::string table =
      "name  machine  cycle  what happened\n"
      "r-1   Mill         5  late\n"
      "r-2   Mill         9  asked for\n";
  EXPECT_EQ(run({"trace"}).out, table);
  EXPECT_EQ(run({"trace", "list"}).out, table);
  appliance_.answers("FlightRecorder.List", {{"records", json::array()}});
  EXPECT_EQ(run({"trace"}).out, "no flight records\n");
}

TEST_F(TraceCommand, ExportsTheNewestRecordWithoutItsHeading) {
  EXPECT_EQ(run({"trace", "export", "-o", "-"}).out, "t_s,q0\n1,2\n");
  EXPECT_THAT(appliance_.params_of("FlightRecorder.Read"),
              ElementsAre(json{{"Name", "r-2"}, {"Offset", 0}}, json{{"Name", "r-2"}, {"Offset", 7}}));
}

TEST_F(TraceCommand, ExportsTheRecordThatIsNamedToAFile) {
  const std::string file = testing::TempDir() + "trace_test.csv";
  EXPECT_EQ(run({"trace", "export", "r-1", "--output", file}).out, file + "\n");
  std::ifstream written(file);
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(written), {}), "t_s,q0\n1,2\n");
  EXPECT_EQ(appliance_.params_of("FlightRecorder.Read").front().at("Name"), "r-1");
}

TEST_F(TraceCommand, SaysThatARecordCameIncomplete) {
  appliance_.answers("FlightRecorder.Read", {{"text", ""}, {"next_offset", 7}});
  EXPECT_EQ(run({"trace", "export", "-o", "-"}).err, "rmac: flight record r-2 came incomplete\n");
}

TEST_F(TraceCommand, SaysThatThereIsNothingToExport) {
  appliance_.answers("FlightRecorder.List", {{"records", json::array()}});
  EXPECT_THAT(run({"trace", "export"}).err, HasSubstr("there is no flight record yet"));
}

TEST_F(TraceCommand, SaysWhereItCannotWrite) {
  const auto failed = run({"trace", "export", "-o", "/nonexistent/r.csv"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: /nonexistent/r.csv: cannot be opened: No such file or directory\n");
}

TEST_F(TraceCommand, WaitsUntilTheRecordThatItAskedForIsWritten) {
  using Kind = gateway::Event::Kind;
  appliance_.handles("FlightRecorder.Record", [&](const json&) {
    appliance_.push_event(Kind::FlightRecord, {{"record", "r-2"}, {"message", "another one"}});
    appliance_.push_event(Kind::FlightRecord, {{"record", "r-3"}, {"message", "r-3 is written"}});
    return gateway::Answer("r-3");
  });
  EXPECT_EQ(run({"trace", "record"}).out, "r-3 is written\n");
  EXPECT_EQ(run({"trace", "record", "--json"}).out, "{\"name\":\"r-3\"}\n");
}

TEST_F(TraceCommand, TellsWhyTheRecordIsNotWritten) {
  appliance_.handles("FlightRecorder.Record", [&](const json&) {
    appliance_.push_event(gateway::Event::Kind::FlightRecordFailed,
                          {{"record", "r-3"}, {"message", "the disk is full"}});
    return gateway::Answer("r-3");
  });
  const auto failed = run({"trace", "record"});
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_EQ(failed.err, "rmac: the disk is full\n");
}

TEST_F(TraceCommand, FetchesNothingForAPictureThatCannotBeDrawn) {
  EXPECT_THAT(run({"trace", "plot", "r-1", "-o", "x.txt"}).err, HasSubstr("ends in .png, .svg or .pdf"));
  EXPECT_THAT(run({"trace", "plot", "r-1", "-o", "/nonexistent/x.png"}).err, HasSubstr("cannot be written"));
  EXPECT_THAT(appliance_.methods(), testing::IsEmpty());
}

}  // namespace
}  // namespace rmac::cli
