#include "honest_circle.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "gateway/threads/sanitized.hpp"

namespace rmac::mill_test {
namespace {

constexpr HonestCircle::Known kAll{.presliding = 0.01, .cogging = 0.02};
constexpr double kFast = 2000;  // mm/min
const std::vector<double> kFeeds = kSanitized ? std::vector{kFast} : std::vector{500.0, kFast};

TEST(CoggingAndPresliding, AreSeenInTheCircleWhereTheyAreNotKnown) {
  EXPECT_GT(HonestCircle().measure(kFast, {}).contour_rms(), 0.005);
}

TEST(CoggingAndPresliding, LeaveHalfAMicrometreWhereTheyAreKnown) {
  for (const double feed : kFeeds) {
    const Ballbar ballbar = HonestCircle().measure(feed, kAll);
    EXPECT_LT(ballbar.contour_rms(), 0.0008) << feed;
    EXPECT_LT(ballbar.reversal_spike(), 0.005) << feed;
    RecordProperty("contour_rms_um_F" + std::to_string(static_cast<int>(feed)),
                   std::to_string(1e3 * ballbar.contour_rms()));
  }
}

TEST(CoggingAndPresliding, AreBothNeeded) {
  EXPECT_GT(HonestCircle().measure(kFast, {.cogging = kAll.cogging}).contour_rms(), 0.002);
  EXPECT_GT(HonestCircle().measure(kFast, {.presliding = kAll.presliding}).contour_rms(), 0.002);
}

// At rest the integral finds bristles bent otherwise than they were as the joint came to rest; the way back begins
// there.
TEST(CoggingAndPresliding, ARestBeforeAJointTurnsRoundDoesNotMatter) {
  for (const double rest_s : {0.1, 1.0, 3.0}) {
    const double error = HonestCircle().back_after_rest(rest_s, kAll);
    EXPECT_LT(error, 0.0075) << rest_s << " s";
    RecordProperty("error_um_behind_ms_" + std::to_string(std::lround(1000 * rest_s)), std::to_string(1e3 * error));
  }
}

// The loop has to bear twice the motor's own cogging, and friction that is nowhere what was found.
TEST(CoggingAndPresliding, MayBeWrongWithoutAFault) {
  for (const double feed : kFeeds) {
    HonestCircle wrong_way_round;
    static_cast<void>(wrong_way_round.measure(feed, {.presliding = 0.1, .cogging = -kAll.cogging}));
    EXPECT_FALSE(wrong_way_round.failed()) << feed;
  }
}

}  // namespace
}  // namespace rmac::mill_test
