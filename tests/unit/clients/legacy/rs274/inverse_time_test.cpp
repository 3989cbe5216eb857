// G93: F is how many such moves a minute has.
#include <gmock/gmock.h>

#include "unit/clients/legacy/fanuc/imported.hpp"
#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::StartsWith;

/// Of the feed moves behind the first rapid.
std::vector<double> feeds_of(const std::string& lines, const Options& options = {}) {
  std::vector<double> feeds;
  double feed = 0;
  for (const auto& request : imported(program_of(lines), options).requests) {
    if (request["method"] == "RMAC_CAM.SetFeedrate") feed = request["params"]["Feedrate"].get<double>();
    if (request["params"].contains("EndPoint")) feeds.push_back(feed);
  }
  return feeds;
}

TEST(Rs274InverseTime, GivesEachMoveItsTime) {
  EXPECT_THAT(feeds_of("G93 G1 X10 F2\nF3 Z4\nG2 X20 I5 F4\nG94 F70 G1 X0"),
              ElementsAre(20, 18, DoubleNear(5 * M_PI * 4, 1e-6), 70));
  EXPECT_THAT(feeds_of("G93 G1 X20 F0.05\nX20.5 F0.05"), ElementsAre(1, 0.1)) << "mm/min at least, as LinuxCNC has it";
  EXPECT_THAT(feeds_of("G93 G20 G1 X1 F2"), ElementsAre(50.8)) << "F counts moves in any unit";
  EXPECT_THAT(feeds_of("G93\nG1 X[#<_inverse_time> * 8 + #<_units_per_minute>] F1"), ElementsAre(8));
  EXPECT_THAT(feeds_of("G93 G3 X0 Y0 I5 Z4 P2 F1"), ElementsAre(DoubleNear(std::hypot(20 * M_PI, 6), 1e-6)));
}

TEST(Rs274InverseTime, IsThatOfTheContourBesideWhichTheToolGoes) {
  const auto feeds = feeds_of("G93 G41.1 D2 G1 X10 F5\nY10 F6\nG3 X0 Y20 I-10 F5\nG40 G1 X-10 F7");
  EXPECT_THAT(feeds, ElementsAre(50, 60, DoubleNear(25 * M_PI, 1e-6), testing::_)) << "as rs274 has it";
}

TEST(Rs274InverseTime, OfAMoveThatTurnsATableIsTheWholeMoves) {
  Options options;
  options.rotary = {{'A', 1, {{0, 0, -10}}}};
  EXPECT_THAT(feeds_of("G93 G1 A90 F2\nX30 A0 F2", options),
              ElementsAre(DoubleNear(20 * M_PI, 1e-6), DoubleNear(2 * std::hypot(10 * M_PI, 30), 1e-6)));
  EXPECT_THAT(feeds_of("G1 Z-10\nG93 A90 F2", options).back(), 180) << "degrees where the tip rests";
  EXPECT_THAT(feeds_of("G93 G1 A90 F0.05", options), ElementsAre(DoubleNear(0.05 * 20 * M_PI / 2, 1e-6)));
  EXPECT_THAT(feeds_of("G93 G1 X30 A90 F0.05", options),
              ElementsAre(DoubleNear(0.05 * std::hypot(10 * M_PI, 30), 1e-6)));
  EXPECT_THAT(feeds_of("G93 G1 X30 A90 F0.001", options),
              ElementsAre(DoubleNear(0.1 / 30 * std::hypot(10 * M_PI, 30), 1e-6)))
      << "X, Y and Z go at 0.1 at least, as in LinuxCNC";
}

TEST(Rs274InverseTime, NeedsAnFInEachMove) {
  EXPECT_THAT(refusal_of(program_of("G93 G1 X10")), StartsWith("3:5: under G93 each move at feed has an F"));
  EXPECT_THAT(refusal_of(program_of("G93 F3\nG1 X10")), StartsWith("4:1: under G93"));
  EXPECT_THAT(refusal_of(program_of("G93 G1 X10 F3\nG0 X0\nG2 X5 R9")), StartsWith("5:1: under G93"));
  EXPECT_THAT(refusal_of(program_of("G93 G1 X10 F0")), StartsWith("3:12: F under G93"));
  EXPECT_THAT(refusal_of(program_of("G93 G1 X10 F5\nG94 X20")), StartsWith("4:5: no feed was set"));
  EXPECT_THAT(refusal_of(program_of("G93 G81 X1 Z-1 R1 F3")), StartsWith("3:5: a canned cycle"));
  EXPECT_THAT(refusal_of(program_of("G93 G5 I3 J3 P4 Q5 X10 F3")), StartsWith("3:5: a spline under G93"));
  EXPECT_EQ(refusal_of(program_of("G93\nG0 X3\nG94 F5 G1 X4")), "taken");
}

TEST(FanucInverseTime, IsTheSame) {
  const auto requests = fanuc::imported(fanuc::program_of("G93 G1 X10. F2.\nX0 F5")).requests;
  EXPECT_EQ(requests[1]["params"]["Feedrate"], 20);
  EXPECT_EQ(requests[3]["params"]["Feedrate"], 50);
  EXPECT_EQ(fanuc::value_of("#4005", "G93\n"), 93);
  EXPECT_EQ(fanuc::imported(fanuc::program_of("G93 G1 X10. F0.05")).requests.at(1)["params"]["Feedrate"], 0.5);
  fanuc::Options options;
  options.rotary = {{'A', 1, {{0, 0, -10}}}};
  const auto turn = fanuc::imported(fanuc::program_of("G93 G1 A90. F0.05"), options).requests.at(1);
  EXPECT_NEAR(turn["params"]["Feedrate"].get<double>(), 0.05 * 20 * M_PI / 2, 1e-6);
  EXPECT_THAT(fanuc::refusal_of(fanuc::program_of("G93 G1 X10. F2.\nX0")), StartsWith("6:1: under G93"));
}

}  // namespace
}  // namespace rmac::rs274
