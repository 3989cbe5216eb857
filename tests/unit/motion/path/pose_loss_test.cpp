// Joints of a parallel machine are not led to where its tool has no pose.
#include <gmock/gmock.h>

#include <random>

#include "rmac/motion/path_builder.hpp"
#include "unit/planar_arm.hpp"

namespace rmac::test {
namespace {

/// An arm that has no pose while its shoulder is within a wedge.
class ArmWithAWedge final : public Kinematics {
 public:
  static constexpr double kFrom = 40, kTo = 45;
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 3; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override { return arm_.joint_type(joint); }
  [[nodiscard]] bool has_pose(std::span<const double> q) const noexcept override { return q[0] < kFrom || q[0] > kTo; }
  void forward(std::span<const double> q, const Frame& tool, ToolPose& pose) const noexcept override {
    arm_.forward(q, tool, pose);
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> q) const noexcept override {
    const KinematicsStatus status = arm_.inverse(pose, tool, seed, q);
    return status == KinematicsStatus::Ok && !has_pose(q) ? KinematicsStatus::OutOfReach : status;
  }
  void jacobian(std::span<const double> q, const Frame& tool, std::span<double> rows) const noexcept override {
    arm_.jacobian(q, tool, rows);
  }

 private:
  PlanarArm arm_;
};

class Wedge : public testing::Test {
 protected:
  Wedge() { model_.kinematics = std::make_shared<ArmWithAWedge>(); }
  std::string refusal(double from, Geometry geometry) {
    PathBuilder builder(model_);
    builder.restart(std::vector<double>{from, 60, -50}, {});
    Move move;
    move.id = 3;
    move.feed_mm_s = 20;
    move.geometry = std::move(geometry);
    const auto segments = builder.build(move);
    return segments ? "" : segments.error().message;
  }
  static Geometry to(double shoulder) { return JointTargetGeometry{{shoulder, 60, -50}}; }

  PlannerModel model_ = planar_arm();
};

TEST_F(Wedge, IsNotEnteredNorCrossedByJoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> below(-160, 39.9), inside(40, 45), above(45.1, 160);
  for (int i = 0; i < 200; ++i) {
    EXPECT_EQ(refusal(below(random), to(below(random))), "");
    EXPECT_EQ(refusal(above(random), to(above(random))), "");
    for (const auto& [from, end] :
         {std::pair(below(random), inside(random)), std::pair(below(random), above(random)),
          std::pair(above(random), below(random)), std::pair(above(random), inside(random))}) {
      const std::string message = refusal(from, to(end));
      ASSERT_THAT(message, testing::HasSubstr("no pose")) << from << " to " << end;
      EXPECT_THAT(message,
                  testing::AllOf(testing::HasSubstr("Shoulder at 4"), testing::HasSubstr("nothing was queued")));
    }
    // Who stands there may leave it, and not go about in it.
    EXPECT_EQ(refusal(inside(random), to(below(random))), "");
    EXPECT_EQ(refusal(inside(random), to(above(random))), "");
    EXPECT_THAT(refusal(inside(random), to(inside(random))), testing::HasSubstr("no pose"));
  }
}

TEST_F(Wedge, HasNoPlaceWhereAMoveOfTheToolBegins) {
  const std::string message = refusal(42, PathTargetGeometry{{{200, 0, -50}, {0, 0, 1}}});
  EXPECT_THAT(message, testing::AllOf(testing::HasSubstr("begins where the tool has no pose"),
                                      testing::HasSubstr("Shoulder at 42"), testing::HasSubstr("JogJoint")));
}

TEST_F(Wedge, IsNotCrossedByTheTool) {
  PathBuilder builder(model_);
  builder.restart(std::vector<double>{30, 60, -50}, {});
  ToolPose there;
  model_.kinematics->forward(std::vector<double>{60, 60, -50}, {}, there);
  Move move;
  move.feed_mm_s = 20;
  move.geometry = LineGeometry{builder.end_pose(), there};
  const auto segments = builder.build(move);
  ASSERT_FALSE(segments);
  EXPECT_THAT(segments.error().message, testing::HasSubstr("out of this mechanism's reach"));
}

}  // namespace
}  // namespace rmac::test
