// LinuxCNC's fourth axis, where it turns the part.
#include <gmock/gmock.h>

#include "unit/clients/legacy/rs274/imported.hpp"

namespace rmac::rs274 {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

Options a_table() {
  Options options;
  options.rotary = {{'A', 1, {{0, 0, -10}}}};
  return options;
}

auto near(double x, double y, double z) {
  return ElementsAre(DoubleNear(x, 1e-6), DoubleNear(y, 1e-6), DoubleNear(z, 1e-6));
}

double feed_of(const std::string& lines, const Options& options) {
  double feed = 0;
  for (const auto& request : imported(program_of(lines), options).requests) {
    if (request["method"] == "RMAC_CAM.SetFeedrate") feed = request["params"]["Feedrate"].get<double>();
  }
  return feed;
}

TEST(Rs274Turntable, TurnsThePartBelowTheTool) {
  EXPECT_THAT(ends_of("g0 a90\ng1 x3 y4 z5\na0", a_table()),
              ElementsAre(near(0, -20, -10), near(3, -15, -6), near(3, 4, 5)));
  EXPECT_THAT(ends_of("(wound) G1 A360 (three arcs)\nG91 A-90", a_table()).back(), near(0, 20, -10));
  EXPECT_THAT(ends_of("G1 A#<_x>\nX[#<_z> + 1]", a_table()).back(), near(11, 0, 10)) << "X, Y and Z are the machine's";
}

TEST(Rs274Turntable, FeedsByXYZAndByDegreesWhereThoseStand) {
  // 2 pi 10 and 30 mm in 30 / 600 minutes; a quarter in 90 / 600.
  EXPECT_NEAR(feed_of("G1 Z0\nX30 A360", a_table()), std::hypot(20 * M_PI, 30) * 20, 1e-6);
  EXPECT_NEAR(feed_of("G1 Z0\nA90", a_table()), 5 * M_PI * 600 / 90, 1e-6);
  EXPECT_NEAR(feed_of("G20\nF60 (inches, or degrees)\nA90 G1", a_table()), 10 * M_PI * 60 / 90, 1e-6);
}

TEST(Rs274Turntable, HasATipThatInchesRoundedBesideTheAxisOnIt) {
  Options options;
  options.rotary = {{'A', 1, {{0, 0, -55}}}};
  const auto requests = imported(program_of("G20 G1 Z-2.1654\nG94 F60 A90"), options).requests;
  const auto turn = requests.at(requests.size() - 2);
  EXPECT_EQ(turn["method"], "RMAC_CAM.MoveAlongLine") << "1.16 micrometres beside it";
  EXPECT_EQ(turn["params"]["EndPoint"], nlohmann::json({{"p", {0, 0, -55.00116}}, {"axis", {0, -1, 0}}}));
  EXPECT_EQ(requests.back()["params"]["EndPoint"], nlohmann::json({{"p", {0, 0.00116, -55}}, {"axis", {0, -1, 0}}}));
  EXPECT_EQ(feed_of("G20 G1 Z-2.1654\nG94 F60 A90", options), 60) << "degrees a minute";
}

TEST(Rs274Turntable, TurnsByNextToNothingOnALine) {
  for (const char* line : {"X30 A0.002", "A0.002", "Y0.001 A0.001"}) {
    const auto requests = imported(program_of("G1 Z10\n" + std::string(line)), a_table()).requests;
    EXPECT_EQ(requests.back()["method"], "RMAC_CAM.MoveAlongLine") << line;
  }
  EXPECT_EQ(imported(program_of("G1 X30 A0.02"), a_table()).requests.back()["method"], "RMAC_CAM.MoveAlongArc");
}

TEST(Rs274Turntable, DoesNotTurnInACycleOrAnArc) {
  EXPECT_THAT(refusal_of(program_of("G81 X1 A9 Z0 R5"), a_table()), StartsWith("3:8: a table turns by a G0 between"));
  EXPECT_THAT(refusal_of(program_of("G2 X10 I5 A9"), a_table()), HasSubstr("is a G0 or G1"));
  EXPECT_THAT(refusal_of(program_of("G80\nA9"), a_table()), StartsWith("4:1: no G0 or G1"));
}

TEST(Rs274Turntable, HasItsSystemsRestoredAround) {
  Options options = a_table();
  options.offsets = {{0, {0, 0, 0}}, {1, {7, 2, 3}}};
  EXPECT_THAT(ends_of("M70\nA90 G0\nG55\nM72\nG0 Y4 Z5", options).back(), near(0, -15, -6));
}

}  // namespace
}  // namespace rmac::rs274
