#include "gateway/rmac/program/program.hpp"

#include <gmock/gmock.h>

#include <fstream>

namespace rmac::cli {
namespace {

using testing::HasSubstr;

const std::string kMoveLine = R"({"jsonrpc":"2.0","method":"RMAC_CAM.MoveToXYZ","params":{"MoveID":5,"x":1}})";

Result<Program> read(const std::string& text) {
  const std::string file = testing::TempDir() + "program_test.rmac";
  std::ofstream(file, std::ios::binary) << text;
  auto program = read_program(file);
  if (!program) {
    // What follows the folder, which is another on every computer.
    auto& message = program.error().message;
    if (message.starts_with(testing::TempDir())) message.erase(0, testing::TempDir().size());
  }
  return program;
}

std::string error_of(const std::string& text) {
  const auto program = read(text);
  return program ? "no error" : program.error().message;
}

TEST(Program, HoldsItsRequestsWithTheirLines) {
  const auto program = read("\n" + kMoveLine + "\r\n \t\n" + R"({"method":"Device.Load","params":{"Name":"Hexapod"}})" +
                            "\n" + R"({"id":3,"method":"RMAC_CAM.CycleStart","params":["MANUAL"]})");
  ASSERT_TRUE(program) << program.error().message;
  ASSERT_EQ(program->requests.size(), 3U);
  EXPECT_EQ(program->requests[0].line, 2);
  EXPECT_EQ(program->requests[0].move_id, 5);
  EXPECT_EQ(program->requests[0].params().at("x"), 1);
  EXPECT_EQ(program->requests[1].line, 4);
  EXPECT_EQ(program->requests[2].line, 5) << "the last line needs no end";
  EXPECT_EQ(program->moves, 1U);
  EXPECT_TRUE(program->loads_mechanism);
  EXPECT_TRUE(program->starts_cycle);
}

TEST(Program, OfAnotherControlIsToldByTheLinesOfItsSource) {
  const auto program =
      read_imported(R"({"id":7,"method":"RMAC_CAM.SetFeedrate","params":{"Feedrate":1}})"
                    "\n" +
                        std::string(R"({"id":7,"method":"RMAC_CAM.Dwell","params":{"MoveID":7,"Time":1}})"),
                    "part.ngc");
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->file, "part.ngc");
  ASSERT_EQ(program->requests.size(), 2U);
  EXPECT_EQ(program->requests[0].line, 7);
  EXPECT_EQ(program->requests[1].line, 7);
}

TEST(Program, TakesTheIdOfAMoveByItsPlaceToo) {
  const auto program = read(R"({"method":"RMAC_CAM.MoveToXYZ","params":[8,1,2,3,10]})");
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_EQ(program->requests[0].move_id, 8);
}

TEST(Program, KnowsAToolChangeThatHasNoId) {
  const auto program = read(R"({"method":"RMAC_CAM.DoToolChange","params":{"ToolNumber":4}})");
  ASSERT_TRUE(program) << program.error().message;
  EXPECT_TRUE(program->requests[0].tool_change);
  EXPECT_EQ(program->moves, 0U);
}

TEST(Program, RefusesAMoveWithoutAnId) {
  const std::string wanted = "program_test.rmac:2: RMAC_CAM.MoveToXYZ needs an integer MoveID";
  EXPECT_EQ(error_of("\n"
                     R"({"method":"RMAC_CAM.MoveToXYZ","params":{"x":1}})"),
            wanted);
  EXPECT_EQ(error_of("\n"
                     R"({"method":"RMAC_CAM.MoveToXYZ","params":{"MoveID":1.5}})"),
            wanted);
  EXPECT_EQ(error_of("\n"
                     R"({"method":"RMAC_CAM.MoveToXYZ","params":[]})"),
            wanted);
  EXPECT_EQ(error_of("\n"
                     R"({"method":"RMAC_CAM.MoveToXYZ"})"),
            wanted);
}

TEST(Program, NamesTheLineThatIsNoRequest) {
  EXPECT_THAT(error_of(kMoveLine + "\nG1 X5\n"), testing::AllOf(testing::StartsWith("program_test.rmac:2: "),
                                                                HasSubstr("write one JSON-RPC request a line")));
  EXPECT_EQ(error_of("[1]"), "program_test.rmac:1: a request is one JSON object, no array");
  EXPECT_EQ(error_of(R"({"result":true})"),
            "program_test.rmac:1: a request has no member \"result\"; it has \"jsonrpc\", \"id\", \"method\" and "
            "\"params\"");
  EXPECT_EQ(error_of(R"({"id":4})"),
            "program_test.rmac:1: the request has no \"method\": a program holds requests only");
  EXPECT_EQ(error_of(R"({"method":4})"),
            "program_test.rmac:1: the request has no \"method\": a program holds requests only");
  EXPECT_EQ(error_of(R"({"method":"RMAC_CAM.Home","params":4})"),
            "program_test.rmac:1: \"params\" of RMAC_CAM.Home is neither an object nor an array");
}

TEST(Program, RefusesALineThatTheApplianceWouldNotTake) {
  const std::string at_most(8U << 20U, ' ');
  EXPECT_EQ(error_of(kMoveLine + "\n" + at_most + "x"), "program_test.rmac:2: more than 8388608 bytes are no request");
  EXPECT_TRUE(read(kMoveLine + "\n" + at_most + "\n"));
}

TEST(Program, RefusesAFileWithoutRequests) {
  EXPECT_EQ(error_of("\n\n"), "program_test.rmac: holds no request");
}

TEST(Program, SaysWhyAFileCannotBeRead) {
  const auto program = read_program("/nonexistent.rmac");
  ASSERT_FALSE(program);
  EXPECT_EQ(program.error().message, "/nonexistent.rmac: cannot be read: No such file or directory");
}

}  // namespace
}  // namespace rmac::cli
