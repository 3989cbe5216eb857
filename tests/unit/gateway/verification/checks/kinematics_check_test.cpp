// What kinematics that are no plain chain promise: poses that joints lack, and a joint that the pose leaves over.
#include "gateway/verification/checks/kinematics_check.hpp"

#include <gmock/gmock.h>

#include "gateway/verification/checks/reach_check.hpp"
#include "unit/planar_arm.hpp"

namespace rmac::verifier {
namespace {

using testing::HasSubstr;

/// A planar arm with a spin of the tool about itself behind it, which changes no pose.
class SpinningArm : public Kinematics {
 public:
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 4; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override {
    return joint == 2 ? JointType::Linear : JointType::Rotary;
  }
  [[nodiscard]] std::optional<std::size_t> free_joint() const noexcept override { return 3; }
  void forward(std::span<const double> q, const Frame& tool, ToolPose& pose) const noexcept override {
    arm_.forward(q.first(3), tool, pose);
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> q) const noexcept override {
    q[3] = seed[3];
    return arm_.inverse(pose, tool, seed.first(3), q.first(3));
  }
  [[nodiscard]] std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                      std::span<double> out) const noexcept override {
    std::array<double, 6> arms{};
    const std::size_t count = arm_.solutions(pose, tool, seed.first(3), arms);
    for (std::size_t i = 0; i < count; ++i) {
      std::copy_n(&arms[3 * i], 3, &out[4 * i]);
      out[4 * i + 3] = seed[3];
    }
    return count;
  }
  void jacobian(std::span<const double> q, const Frame& tool, std::span<double> rows) const noexcept override {
    std::array<double, 18> arm{};
    arm_.jacobian(q.first(3), tool, arm);
    for (std::size_t row = 0; row < 6; ++row) {
      std::copy_n(&arm[3 * row], 3, &rows[4 * row]);
      rows[4 * row + 3] = 0;
    }
  }

 private:
  test::PlanarArm arm_;
};

class WindsUp final : public SpinningArm {
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> q) const noexcept override {
    const KinematicsStatus status = SpinningArm::inverse(pose, tool, seed, q);
    q[3] = seed[3] + 1e-3;
    return status;
  }
};

/// Has no pose where the quill is far up, as it says; its inverse leads it there all the same, if it is told to.
class ShortQuill final : public Kinematics {
 public:
  explicit ShortQuill(double from_mm, bool forgets = false) : from_(from_mm), forgets_(forgets) {}
  [[nodiscard]] std::size_t joint_count() const noexcept override { return 3; }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override { return arm_.joint_type(joint); }
  [[nodiscard]] bool has_pose(std::span<const double> q) const noexcept override { return q[2] <= from_; }
  void forward(std::span<const double> q, const Frame& tool, ToolPose& pose) const noexcept override {
    arm_.forward(q, tool, pose);
    if (!has_pose(q)) pose.tip.fill(std::nan(""));
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> q) const noexcept override {
    const KinematicsStatus status = arm_.inverse(pose, tool, seed, q);
    return status != KinematicsStatus::Ok || has_pose(q) || forgets_ ? status : KinematicsStatus::OutOfReach;
  }
  [[nodiscard]] std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                      std::span<double> out) const noexcept override {
    const std::size_t count = arm_.solutions(pose, tool, seed, out);
    return count > 0 && out[2] > from_ && !forgets_ ? 0 : count;
  }
  void jacobian(std::span<const double> q, const Frame& tool, std::span<double> rows) const noexcept override {
    arm_.jacobian(q, tool, rows);
  }

 private:
  test::PlanarArm arm_;
  double from_;
  bool forgets_;
};

KinematicsCase arm_case(bool spins) {
  KinematicsCase given;
  given.ranges = {{-170, 170}, {-150, 150}, {-100, 0}};
  if (spins) given.ranges.push_back({-350, 350});
  given.samples = 5000;
  return given;
}

std::string refusal(const Kinematics& kinematics, bool spins = false) {
  const Checked checked = check_kinematics(kinematics, arm_case(spins));
  return checked ? "" : to_string(checked.error());
}

TEST(KinematicsCheck, TakesAJointThatThePoseLeavesOver) {
  EXPECT_EQ(refusal(SpinningArm(), true), "");
}

TEST(KinematicsCheck, FindsAJointLeftOverThatIsMovedAllTheSame) {
  EXPECT_THAT(refusal(WindsUp(), true), HasSubstr("leaves joint 3 over, and moves it"));
}

TEST(KinematicsCheck, PassesOverJointsThatHaveNoPose) {
  EXPECT_EQ(refusal(ShortQuill(-30)), "");
}

TEST(KinematicsCheck, FindsThatHardlyAnyJointsHaveAPose) {
  EXPECT_THAT(refusal(ShortQuill(-99)), HasSubstr("narrow the travel"));
}

TEST(KinematicsCheck, FindsAnInverseThatGivesJointsWithoutAPose) {
  KinematicsCase given = arm_case(false);
  EXPECT_TRUE(check_reach(ShortQuill(-30), given));
  const Checked checked = check_reach(ShortQuill(-30, true), given);
  ASSERT_FALSE(checked);
  EXPECT_THAT(to_string(checked.error()), HasSubstr("joints that have no pose"));
}

}  // namespace
}  // namespace rmac::verifier
