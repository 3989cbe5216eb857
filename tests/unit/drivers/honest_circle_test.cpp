#include "honest_circle.hpp"

namespace rmac::mill_test {
namespace {

constexpr HonestCircle::Known kAll{.presliding = 0.01, .cogging = 0.02};
constexpr double kSlow = 500, kFast = 2000;  // mm/min

TEST(CoggingAndPresliding, AreSeenInTheCircleWhereTheyAreNotKnown) {
  EXPECT_GT(HonestCircle().measure(kSlow, {}).contour_rms(), 0.005);
  EXPECT_GT(HonestCircle().measure(kFast, {}).contour_rms(), 0.005);
}

TEST(CoggingAndPresliding, LeaveHalfAMicrometreWhereTheyAreKnown) {
  for (const double feed : {kSlow, kFast}) {
    const Ballbar ballbar = HonestCircle().measure(feed, kAll);
    EXPECT_LT(ballbar.contour_rms(), 0.0008) << feed;
    EXPECT_LT(ballbar.reversal_spike(), 0.005) << feed;
    RecordProperty("contour_rms_um_F" + std::to_string(static_cast<int>(feed)),
                   std::to_string(1e3 * ballbar.contour_rms()));
  }
}

TEST(CoggingAndPresliding, AreBothNeeded) {
  EXPECT_GT(HonestCircle().measure(kSlow, {.cogging = kAll.cogging}).contour_rms(), 0.002);
  EXPECT_GT(HonestCircle().measure(kSlow, {.presliding = kAll.presliding}).contour_rms(), 0.002);
}

// The loop has to bear twice the motor's own cogging, and friction that is nowhere what was found.
TEST(CoggingAndPresliding, MayBeWrongWithoutAFault) {
  for (const double feed : {kSlow, kFast}) {
    HonestCircle wrong_way_round;
    static_cast<void>(wrong_way_round.measure(feed, {.presliding = 0.1, .cogging = -kAll.cogging}));
    EXPECT_FALSE(wrong_way_round.failed()) << feed;
  }
}

}  // namespace
}  // namespace rmac::mill_test
