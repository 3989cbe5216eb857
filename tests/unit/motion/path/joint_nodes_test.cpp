// Straight lines of machines whose joints bend on them: what lies between the ends counts too.
#include <gmock/gmock.h>

#include <random>

#include "rmac/motion/path_builder.hpp"
#include "seeds.hpp"
#include "unit/planar_arm.hpp"

namespace rmac::test {
namespace {

constexpr Vector kUpwards{0, 0, 1};
constexpr int kPlaces = 2000;

class LineOfAnArm : public testing::TestWithParam<unsigned> {
 protected:
  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  std::vector<double> random_joints() {
    std::vector<double> joints;
    for (const JointLimits& joint : model_.joints) joints.push_back(random(joint.min, joint.max));
    return joints;
  }
  Expected<PathSegments> line(const std::vector<double>& from, const Vector& to) {
    builder_.restart(from, {});
    Move move;
    move.id = 1;
    move.feed_mm_s = 50;
    move.geometry = LineGeometry{builder_.end_pose(), {to, kUpwards}};
    return builder_.build(move);
  }
  ToolPose pose_of(const std::vector<double>& joints) const {
    ToolPose pose;
    model_.kinematics->forward(joints, {}, pose);
    return pose;
  }

  PlannerModel model_ = planar_arm();
  PathBuilder builder_{model_};
  std::mt19937_64 random_{GetParam()};
};

INSTANTIATE_TEST_SUITE_P(Seeds, LineOfAnArm, seeds(8));

TEST_P(LineOfAnArm, ThatIsTakenHasJointsWithinTheirTravelAllAlong) {
  int taken = 0;
  for (int i = 0; i < 300; ++i) {
    const auto segments = line(random_joints(), pose_of(random_joints()).tip);
    if (!segments) continue;
    ++taken;
    const PathSegment& segment = *segments->front();
    std::vector<double> before(segment.joints_at_node(0).begin(), segment.joints_at_node(0).end());
    JointPoint point;
    for (int k = 0; k <= kPlaces; ++k) {
      ASSERT_EQ(segment.evaluate(segment.length() * k / kPlaces, 3, k == 0 ? 1 : -1, point), KinematicsStatus::Ok);
      for (std::size_t j = 0; j < 3; ++j) {
        const JointLimits& joint = model_.joints[j];
        ASSERT_GE(point.d[0][j], joint.min - 1.1e-6) << joint.name;
        ASSERT_LE(point.d[0][j], joint.max + 1.1e-6) << joint.name;
        constexpr double kTurns_deg = 30;  // in a place: a jump to the other elbow is more
        ASSERT_LT(std::abs(point.d[0][j] - before[j]), kTurns_deg) << joint.name;
        before[j] = point.d[0][j];
      }
    }
  }
  EXPECT_GT(taken, 30);
}

TEST_P(LineOfAnArm, ThatPassesItsBaseIsRefusedWithThePlace) {
  constexpr double kHole_mm = PlanarArm::kUpper_mm - PlanarArm::kLower_mm;
  for (int i = 0; i < 200; ++i) {
    const std::vector<double> from{random(-100, 100), random(20, 140), -50};
    const Vector tip = pose_of(from).tip;
    // To the other side, past the base within the hole.
    const double angle = std::atan2(tip[1], tip[0]), past = random(-0.99, 0.99) * kHole_mm, far = random(60, 300);
    const double c = std::cos(angle), s = std::sin(angle), aside = past * (1 + far / std::hypot(tip[0], tip[1]));
    const auto segments = line(from, {-far * c - aside * s, -far * s + aside * c, -50});
    ASSERT_FALSE(segments);
    EXPECT_THAT(segments.error().message, testing::HasSubstr("mm along the move"));
  }
}

}  // namespace
}  // namespace rmac::test
