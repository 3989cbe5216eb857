// When the planner tries again after it found no plan. The servo loop is only told of: its cycles are plain numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <utility>

#include "planner/failed_attempt.hpp"
#include "rmac/motion/plan.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

using test::kUp;

/// Three slides that have no solution while they are told to.
class FailingKinematics final : public Kinematics {
 public:
  explicit FailingKinematics(std::shared_ptr<const bool> fails) : fails_(std::move(fails)) {}

  [[nodiscard]] std::size_t joint_count() const noexcept override { return slides_.joint_count(); }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override { return slides_.joint_type(joint); }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    slides_.forward(joints, tool, pose);
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> joints) const noexcept override {
    return *fails_ ? KinematicsStatus::Singular : slides_.inverse(pose, tool, seed, joints);
  }
  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    slides_.jacobian(joints, tool, jacobian);
  }

 private:
  modules::ChainKinematics slides_ = modules::cartesian(3);
  std::shared_ptr<const bool> fails_;
};

/// A planner that was told to run a straight line of 40 mm, and finds no plan while `no_plan()` holds.
class FailedPlan : public ::testing::Test {
 protected:
  FailedPlan() {
    PathBuilder builder(model_);
    Move move;
    move.feed_mm_s = 30;
    move.geometry = LineGeometry{{{0, 0, 0}, kUp}, {{40, 0, 0}, kUp}};
    planner.add(builder.build(move).value());
    planner.command(PathCommand::Run);
    planner.step(at(0));  // lays the line, and plans nothing yet
  }

  void no_plan(bool fails) { *fails_ = fails; }
  [[nodiscard]] ServoProgress at(std::int64_t cycle) const { return {cycle, accepted_, 0, {}}; }
  [[nodiscard]] bool idle(std::int64_t cycle) const { return planner.idle(at(cycle)); }

  /// The plan that is published when there is something to do in this cycle, and is taken at once; else nullptr.
  /// Several steps may look for one.
  const Plan* plan(std::int64_t cycle) {
    const Plan* published = nullptr;
    while (published == nullptr && !planner.idle(at(cycle))) {
      if (planner.step(at(cycle)) && channel_.published.pop(published)) accepted_ = published->id;
    }
    return published;
  }
  /// The first cycle from this one on in which there is something to do.
  [[nodiscard]] std::int64_t next_task(std::int64_t cycle) const {
    for (const std::int64_t end = cycle + 10000; cycle < end && idle(cycle);) ++cycle;
    return cycle;
  }
  [[nodiscard]] static std::int64_t end_cycle(const Plan& plan) {
    return plan.start_cycle + static_cast<std::int64_t>(std::ceil(plan.end_time_s * 1000));
  }

 private:
  [[nodiscard]] static PlannerModel failing_mill(std::shared_ptr<const bool> fails) {
    PlannerModel model = test::mill();
    model.kinematics = std::make_shared<FailingKinematics>(std::move(fails));
    return model;
  }

  std::shared_ptr<bool> fails_ = std::make_shared<bool>(false);
  PlannerModel model_ = failing_mill(fails_);
  PlanChannel channel_;
  std::uint64_t accepted_ = 0;

 protected:
  Planner planner{model_, channel_};
};

TEST_F(FailedPlan, FromRestIsTriedAgainAfterTenCyclesAndNoSooner) {
  no_plan(true);
  ASSERT_FALSE(idle(100));
  EXPECT_EQ(plan(100), nullptr);
  no_plan(false);
  for (std::int64_t cycle = 100; cycle < 110; ++cycle) {
    EXPECT_TRUE(idle(cycle)) << cycle;
    EXPECT_EQ(plan(cycle), nullptr) << cycle;
  }
  EXPECT_FALSE(idle(110));
  EXPECT_NE(plan(110), nullptr);
}

TEST_F(FailedPlan, IsTriedAtOnceAfterAnotherCommand) {
  no_plan(true);
  EXPECT_EQ(plan(100), nullptr);
  planner.command(PathCommand::Run);
  EXPECT_TRUE(idle(101)) << "the same command";
  planner.command(PathCommand::RunOne);
  EXPECT_FALSE(idle(101));
}

TEST_F(FailedPlan, IsTriedAtOnceWithAnotherOverride) {
  no_plan(true);
  EXPECT_EQ(plan(100), nullptr);
  planner.set_override(100);
  EXPECT_TRUE(idle(101)) << "the same override";
  planner.set_override(50);
  EXPECT_FALSE(idle(101));
}

TEST_F(FailedPlan, InMotionIsTriedAgainAfterTenCyclesFromTheSoonestStateThereIs) {
  const Plan* const first = plan(100);
  ASSERT_NE(first, nullptr);
  const std::int64_t cycle = next_task(first->start_cycle);
  ASSERT_LT(cycle, end_cycle(*first));
  no_plan(true);
  EXPECT_EQ(plan(cycle), nullptr);
  no_plan(false);
  EXPECT_EQ(next_task(cycle), cycle + FailedAttempt::kRetryAfter);
  const Plan* const second = plan(cycle + FailedAttempt::kRetryAfter);
  ASSERT_NE(second, nullptr);
  EXPECT_EQ(second->latest_cycle - second->start_cycle, 2 + 9) << "the cycles that planning took";
}

TEST_F(FailedPlan, InMotionDoesNotHoldBackTheStartFromRest) {
  const Plan* const first = plan(100);
  ASSERT_NE(first, nullptr);
  const std::int64_t end = end_cycle(*first);
  no_plan(true);
  EXPECT_EQ(plan(end - 5), nullptr);
  no_plan(false);
  EXPECT_EQ(next_task(end - 4), end);
  EXPECT_NE(plan(end), nullptr);
}

}  // namespace
}  // namespace rmac
