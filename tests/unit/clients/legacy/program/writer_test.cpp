#include "clients/legacy/program/writer.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "clients/legacy/program/machine_switches.hpp"

// The requests of a .rmac file, letter by letter where programs are compared, else by what JSON says.

namespace rmac::legacy {
namespace {

using nlohmann::json;

struct Written {
  std::string text;
  std::vector<std::size_t> parts;  ///< how long each was that the sink got
  Writer writer;
  explicit Written(Ids ids = Ids::Numbers)
      : writer(
            [this](std::string_view part) {
              text += part;
              parts.push_back(part.size());
            },
            ids) {}
  std::string said() {
    text.clear();
    writer.flush();
    return text;
  }
  json params() { return json::parse(said()).at("params"); }
};

TEST(Writer, NamesTheLineOfEachMoveAndNumbersTheRequests) {
  Written written;
  written.writer.at_line(7);
  EXPECT_EQ(written.writer.line(), 7U);
  written.writer.rapid({1, -2.5, 0});
  EXPECT_EQ(written.said(), R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.MoveToPathTarget","params":{"MoveID":7,)"
                            R"("TargetFrame":{"p":[1,-2.5,0],"axis":[0,0,1]}}})"
                            "\n");
  written.writer.at_line(9);
  written.writer.rapid_of_joints({0, 0, 1});
  EXPECT_EQ(written.said(), R"({"jsonrpc":"2.0","id":2,"method":"RMAC_CAM.MoveToJointTarget","params":{"MoveID":9,)"
                            R"("JointTargetFrame":{"p":[0,0,1],"axis":[0,0,1]}}})"
                            "\n");
  Written lines(Ids::Lines);
  lines.writer.at_line(12);
  lines.writer.feed(600);
  EXPECT_EQ(lines.said(), R"({"jsonrpc":"2.0","id":12,"method":"RMAC_CAM.SetFeedrate","params":{"Feedrate":600}})"
                          "\n");
}

TEST(Writer, CountsRequestsMovesAndBytesWhetherFlushedOrNot) {
  Written written;
  Writer& writer = written.writer;
  EXPECT_EQ(writer.bytes(), 0U);
  std::size_t moves = 0, requests = 0;
  const auto expect = [&](std::size_t more_moves, std::size_t more_requests) {
    EXPECT_EQ(writer.moves(), moves += more_moves);
    EXPECT_EQ(writer.requests(), requests += more_requests);
  };
  writer.rapid({1, 0, 0});
  expect(1, 1);
  writer.line({2, 0, 0});
  expect(1, 1);
  writer.line({2, 0, 0});  // no way at all
  expect(0, 0);
  writer.tool_axis({0, 1, 0});
  writer.line({2, 0, 0});  // a turn where it stands
  expect(1, 1);
  writer.arc({.centre = {3, 0, 0}, .end = {4, 0, 0}});
  expect(1, 1);
  writer.nurbs({2, {{4, 0, 0}, {5, 1, 0}, {6, 0, 0}}, {}});
  expect(1, 1);
  writer.pose_spline({std::vector<PoseSpline::Pose>(6), 1});
  expect(1, 1);
  writer.rapid_of_joints({1, 1, 1});
  expect(1, 1);
  writer.feed(5);
  writer.path_tolerance(5);
  writer.part_frame({});
  writer.dwell(1);
  writer.stop(false, "");
  writer.change_tool(1);
  writer.await_input("a", true, 1);
  writer.output("a", true);
  writer.in_turn("");
  expect(0, 9);
  const std::size_t bytes = writer.bytes();
  EXPECT_EQ(written.said().size(), bytes);
  EXPECT_EQ(writer.bytes(), bytes);
}

TEST(Writer, HandsOnWhatItHasByTheMegabyte) {
  Written written;
  for (int i = 0; i < 60'000; ++i) written.writer.dwell(i);
  ASSERT_FALSE(written.parts.empty());
  for (const std::size_t size : written.parts) {
    EXPECT_GE(size, 1U << 20U);
    EXPECT_LT(size, (1U << 20U) + 200);
  }
  const std::size_t bytes = written.writer.bytes();
  written.writer.flush();
  EXPECT_EQ(written.text.size(), bytes);
}

TEST(Writer, BeginsLinesAndArcsWhereTheMoveBeforeEnded) {
  Written written;
  Writer& writer = written.writer;
  writer.rapid({1, 2, 3});
  written.said();
  writer.tool_axis({0, 0.6, 0.8});
  writer.line({4, 5, 6});
  EXPECT_EQ(written.params(), json::parse(R"({"MoveID":0,"StartPoint":{"p":[1,2,3],"axis":[0,0,1]},
                                              "EndPoint":{"p":[4,5,6],"axis":[0,0.6,0.8]}})"));
  writer.begin({7, 8, 9});
  writer.arc({.centre = {1, 0, 0}, .end = {2, 0, 0}, .axis = {1, 0, 0}, .counter_clockwise = true});
  EXPECT_EQ(written.params(), json::parse(R"({"MoveID":0,"RotSign":1,"Closed":false,
      "CenterPoint":{"p":[1,0,0],"axis":[1,0,0]},"StartPoint":{"p":[7,8,9],"axis":[0,0.6,0.8]},
      "EndPoint":{"p":[2,0,0],"axis":[0,0.6,0.8]}})"));
  writer.arc({.centre = {3, 0, 0}, .end = {2, 0, 0}, .closed = true, .more_turns = 2});
  EXPECT_EQ(written.params(), json::parse(R"({"MoveID":0,"RotSign":-1,"Closed":true,"Turns":2,
      "CenterPoint":{"p":[3,0,0],"axis":[0,0,1]},"StartPoint":{"p":[2,0,0],"axis":[0,0.6,0.8]},
      "EndPoint":{"p":[2,0,0],"axis":[0,0.6,0.8]}})"));
  writer.arc({.centre = {3, 0, 0}, .end = {4, 0, 0}, .more_turns = 1});
  EXPECT_EQ(written.params().at("Turns"), 1);
}

/// Degree and knots are those of a B-spline with even knots, clamped at its ends.
TEST(Writer, GivesANurbsEvenKnotsFromItsFirstPointToItsLast) {
  for (int degree = 1; degree <= 5; ++degree) {
    for (int points = degree + 1; points <= degree + 6; ++points) {
      Written written;
      Nurbs curve{degree, {}, {}};
      for (int i = 0; i < points; ++i) curve.points.push_back({1.0 * i, 2.0 * i, -1.0 * i});
      written.writer.at_line(3);
      written.writer.nurbs(curve);
      const json params = written.params();
      const json& nurbs = params.at("Nurbs");
      EXPECT_EQ(params.at("MoveID"), 3);
      EXPECT_EQ(nurbs.at("degree"), degree);
      ASSERT_EQ(nurbs.at("points").size(), curve.points.size());
      EXPECT_EQ(nurbs.at("points").at(1), json::array({1, 2, -1}));
      EXPECT_FALSE(nurbs.contains("weights"));
      const auto knots = nurbs.at("knots").get<std::vector<int>>();
      ASSERT_EQ(static_cast<int>(knots.size()), points + degree + 1);
      const int last = points - degree;
      EXPECT_EQ(std::ranges::count(knots, 0), degree + 1);
      EXPECT_EQ(std::ranges::count(knots, last), degree + 1);
      for (int inner = 1; inner < last; ++inner) EXPECT_EQ(knots.at(static_cast<std::size_t>(degree + inner)), inner);
      EXPECT_TRUE(std::ranges::is_sorted(knots));
      written.writer.line({0, 0, 50});
      EXPECT_EQ(written.params().at("StartPoint").at("p").at(0), points - 1) << "from the curve's end";
    }
  }
  Written weighed;
  weighed.writer.nurbs({1, {{0, 0, 0}, {1, 0, 0}}, {1, 2.5}});
  EXPECT_EQ(weighed.params().at("Nurbs").at("weights"), json::array({1, 2.5}));
}

TEST(Writer, GivesAPoseSplineThreefoldKnotsWithin) {
  for (int pieces = 1; pieces <= 4; ++pieces) {
    Written written;
    PoseSpline curve{{}, pieces};
    for (int i = 0; i < 3 * pieces + 3; ++i) curve.points.push_back({1.0 * i, 2, 3, 0.1, 0.2, 1});
    written.writer.tool_axis({0, 1, 0});
    written.writer.pose_spline(curve);
    const json params = written.params();
    const json& nurbs = params.at("NurbsND");
    EXPECT_EQ(nurbs.at("space"), "pose");
    EXPECT_EQ(nurbs.at("degree"), 5);
    ASSERT_EQ(nurbs.at("points").size(), curve.points.size());
    EXPECT_EQ(nurbs.at("points").at(1), json::array({1, 2, 3, 0.1, 0.2, 1}));
    std::vector<int> knots, multiplicities(static_cast<std::size_t>(pieces) + 1, 3);
    for (int knot = 0; knot <= pieces; ++knot) knots.push_back(knot);
    multiplicities.front() = multiplicities.back() = 6;
    EXPECT_EQ(nurbs.at("knots").get<std::vector<int>>(), knots);
    EXPECT_EQ(nurbs.at("multiplicities").get<std::vector<int>>(), multiplicities);
    written.writer.line({0, 0, 50});
    const json line = written.params();
    EXPECT_EQ(line.at("StartPoint"), json::parse(R"({"p":[0,2,3],"axis":[0,1,0]})")
                                         .patch(json::parse(R"([{"op":"replace","path":"/p/0","value":)" +
                                                            std::to_string(3 * pieces + 2) + "}]")));
  }
}

TEST(Writer, RoundsLengthsToATenthOfANanometreAndDirectionsFiner) {
  Written written;
  written.writer.tool_axis({0.123456789012, -0.00000000004, 1});
  written.writer.rapid({0.123456789, -0.00000004, 0.1 + 0.2});
  EXPECT_THAT(written.said(), testing::HasSubstr(R"("p":[0.1234568,0,0.3],"axis":[0.123456789,0,1])"));
  written.writer.feed(0.1 + 0.2);
  EXPECT_EQ(written.params(), json::parse(R"({"Feedrate":0.3})"));
  written.writer.path_tolerance(0.01 + 1e-9);
  EXPECT_EQ(written.params(), json::parse(R"({"Tolerance":0.01})"));
  std::mt19937 random(3);
  std::uniform_real_distribution<double> mm(-1000, 1000);
  for (int i = 0; i < 200; ++i) {
    const Point end{mm(random), mm(random), mm(random)};
    written.writer.rapid(end);
    const auto p = written.params().at("TargetFrame").at("p").get<std::vector<double>>();
    for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(p.at(axis), end.at(axis), 0.5001e-7);
  }
}

TEST(Writer, WritesWhatStandsBetweenMoves) {
  Written written;
  Writer& writer = written.writer;
  writer.at_line(4);
  writer.part_frame({1, 2, 3});
  EXPECT_EQ(written.params(), json::parse(R"({"PartFrame":{"p":[1,2,3],"q":[1,0,0,0]}})"));
  writer.dwell(0.25);
  EXPECT_EQ(written.params(), json::parse(R"({"MoveID":4,"Time":0.25})"));
  for (const bool on : {false, true}) {
    writer.stop(on, "");
    EXPECT_EQ(written.params(), (json{{"MoveID", 4}, {"Optional", on}}));
    writer.await_input("Door", on, 12.5);
    EXPECT_EQ(written.params(), (json{{"MoveID", 4}, {"Name", "Door"}, {"On", on}, {"TimeOut", 12.5}}));
    writer.output("Clamp", on);
    const json call{{"method", "RMAC_CAM.SetOutput"}, {"params", {{"Name", "Clamp"}, {"On", on}}}};
    EXPECT_EQ(written.params(), (json{{"MoveID", 4}, {"Calls", json::array({call})}}));
  }
  writer.change_tool(12);
  EXPECT_EQ(written.params(), json::parse(R"({"ToolNumber":12})"));
}

/// Whatever a message holds, the request is JSON; letters that no terminal shows are left out.
TEST(Writer, KeepsMessagesThatAreText) {
  Written written;
  const std::string plain = R"( Turn "it" \ over ~!#)";
  written.writer.stop(false, plain);
  EXPECT_EQ(written.params().at("Message"), plain);
  std::string any;
  for (int letter = 0; letter < 256; ++letter) any += static_cast<char>(letter);
  written.writer.stop(false, any);
  std::string shown;
  for (char letter = ' '; letter <= '~'; ++letter) shown += letter;
  EXPECT_EQ(written.params().at("Message"), shown);
}

/// Each write tells what changed since the one before, once.
TEST(MachineSwitches, WriteWhatChangedInOneRequest) {
  Written written;
  MachineSwitches machine(written.writer);
  const auto calls = [&] {
    machine.write();
    const std::string text = written.said();
    return text.empty() ? std::string() : json::parse(text).at("params").at("Calls").dump();
  };
  const auto spindle = [](int rpm) {
    return R"({"method":"RMAC_CAM.SetSpindleRPM","params":{"RPM":)" + json(rpm).dump() + R"(,"SpindleNumber":0}})";
  };
  const auto mist = [](bool on) {
    return R"({"method":"RMAC_CAM.SetOutput","params":{"Name":"Mist","On":)" + json(on).dump() + "}}";
  };
  const std::string on = R"({"method":"RMAC_CAM.TurnCoolantOn"})", off = R"({"method":"RMAC_CAM.TurnCoolantOff"})";
  const auto parsed = [](const std::string& text) { return json::parse("[" + text + "]").dump(); };
  EXPECT_EQ(calls(), "");
  machine.set_speed(1000);
  EXPECT_EQ(machine.rpm(), 1000);
  EXPECT_FALSE(machine.spindle_turns());
  EXPECT_EQ(calls(), "") << "a speed alone turns nothing";
  machine.turn(1);
  EXPECT_TRUE(machine.spindle_turns());
  EXPECT_EQ(calls(), parsed(spindle(1000)));
  EXPECT_EQ(calls(), "");
  machine.turn(-1);
  EXPECT_EQ(machine.direction(), -1);
  machine.set_flood(true);
  machine.set_mist(true);
  EXPECT_TRUE(machine.mist() && machine.flood());
  EXPECT_EQ(calls(), parsed(spindle(-1000) + "," + on + "," + mist(true)));
  machine.set_mist(false);
  EXPECT_EQ(calls(), parsed(mist(false)));
  machine.hold_spindle();
  EXPECT_FALSE(machine.spindle_turns());
  EXPECT_EQ(json::parse(written.said()).at("params").at("Calls").dump(), parsed(spindle(0)));
  machine.release_spindle();
  EXPECT_EQ(json::parse(written.said()).at("params").at("Calls").dump(), parsed(spindle(-1000)));
  machine.tool_was_changed();
  EXPECT_EQ(machine.direction(), 0) << "nobody turns a new tool before a program says so";
  EXPECT_EQ(calls(), parsed(on)) << "the coolant that was on comes on again";
  machine.turn(1);
  EXPECT_EQ(calls(), parsed(spindle(1000)));
  machine.set_mist(true);
  EXPECT_EQ(calls(), parsed(mist(true)));
  machine.off();
  EXPECT_FALSE(machine.mist() || machine.flood() || machine.spindle_turns());
  EXPECT_EQ(json::parse(written.said()).at("params").at("Calls").dump(),
            parsed(spindle(0) + "," + off + "," + mist(false)));
  machine.off();
  EXPECT_EQ(written.said(), "");
}

}  // namespace
}  // namespace rmac::legacy
