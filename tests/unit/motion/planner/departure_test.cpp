// A stop that no plan serves in time, and kinematics that fail in mid-path: each joint comes to rest by itself, within
// its limits, and the path goes on where it was left.
#include <gtest/gtest.h>

#include <atomic>
#include <limits>

#include "seeds.hpp"
#include "unit/motion/planner/program_fuzz.hpp"

namespace rmac {
namespace {

using test::Action;
using test::mill;
using test::PlannerBench;

constexpr double kMostOnTheWayBack = 1.001;

void expect_within_limits(const PlannerBench& bench) {
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, kMostOnTheWayBack);
  EXPECT_LE(peaks.acceleration, kMostOnTheWayBack);
  EXPECT_LE(peaks.jerk, kMostOnTheWayBack) << "in cycle " << peaks.jerk_cycle;
}

/// The cycles that a joint needs to come to rest from a setpoint, by the bounds that it has.
int cycles_to_rest(const Setpoint& from, const PlannerModel& model) {
  JointBrake brake(model.joints);
  brake.begin(from);
  return static_cast<int>(std::ceil(brake.duration() / model.period_s));
}

std::size_t queue_program(PlannerBench& bench, unsigned seed) {
  std::size_t queued = 0;
  for (unsigned extra = 0; queued < 6; ++extra) {
    for (const Action& action : test::random_program(seed + 1000 * extra).actions) {
      if (action.kind != Action::Kind::Queue) continue;
      const Move move = test::move_of(action, static_cast<std::int64_t>(queued) + 1, bench.builder.end_pose());
      if (bench.queue(move)) ++queued;
    }
  }
  return queued;
}

class Departure : public ::testing::TestWithParam<unsigned> {};

TEST_P(Departure, JointsRestInTheTimeTheirLimitsNeedAndThePathGoesOnWhereItWasLeft) {
  const PlannerModel model = mill(GetParam() % 2 == 0 ? 10000 : 50000);
  PlannerBench bench(model);
  std::mt19937 random(GetParam());
  const std::size_t queued = queue_program(bench, GetParam());
  std::uint64_t departures = 0;
  while (bench.planner.moves_left() > 0) {
    bench.planner.command(PathCommand::Run);
    for (int wait = std::uniform_int_distribution(1, 400)(random); wait > 0; --wait) bench.cycle();
    const Setpoint left = bench.record.back();
    if (!left.moving) continue;
    const bool was_off_path = bench.planner.off_path();
    bench.follower().leave();
    EXPECT_FALSE(was_off_path);
    ++departures;
    // The planner hangs until the joints stand, or works all the time.
    const int needed = std::max(cycles_to_rest(left, model), 1);
    bench.cycles_without_planner(departures % 2 == 0 ? needed : 1);
    if (departures % 2 == 0) {
      EXPECT_FALSE(bench.record.back().moving);
    }
    bench.planner.command(PathCommand::Stop);
    ASSERT_TRUE(bench.run(needed + 1));
    EXPECT_EQ(bench.progress().departure.count, departures);
    ASSERT_TRUE(bench.planner.off_path());
    const std::vector<double> joints(bench.record.back().position.begin(), bench.record.back().position.begin() + 3);
    ASSERT_TRUE(bench.planner.rejoin(joints));
    if (departures % 3 == 0) {  // stopped on the way back too
      bench.planner.command(PathCommand::Run);
      for (int i = 0; i < 20; ++i) bench.cycle();
      bench.planner.command(PathCommand::Stop);
      ASSERT_TRUE(bench.run(20000));
    }
  }
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_GT(departures, 0U);
  RecordProperty("departures", std::to_string(departures));
  EXPECT_EQ(bench.moves_done(), queued);
  EXPECT_EQ(bench.planner.moves_left(), 0U);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_NEAR(bench.record.back().position[j], bench.builder.end_joints()[j], 1e-9);
  }
  expect_within_limits(bench);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Departure, test::seeds(12));

/// A line of 30 mm along X.
void queue_line(PlannerBench& bench) {
  Move move;
  move.id = 1;
  move.feed_mm_s = 100;
  move.geometry = LineGeometry{{{0, 0, 0}, {0, 0, 1}}, {{30, 20, 0}, {0, 0, 1}}};
  ASSERT_TRUE(bench.queue(move));
}

void run_to(PlannerBench& bench, double x) {
  bench.planner.command(PathCommand::Run);
  while (bench.record.empty() || bench.record.back().position[0] < x) bench.cycle();
}

TEST(LeavingThePath, BeginsAtThePlaceAndTheSpeedOfTheLastSetpoint) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  const Setpoint before = bench.record.back();
  bench.follower().leave();
  bench.cycle();
  const Setpoint& after = bench.record.back();
  EXPECT_TRUE(after.moving);
  EXPECT_NEAR(after.position[0], before.position[0] + before.velocity[0] * 0.001, 1e-3);
}

TEST(LeavingThePath, IsNothingAtRest) {
  PlannerBench bench(mill());
  queue_line(bench);
  bench.follower().leave();
  bench.cycle();
  EXPECT_EQ(bench.progress().departure.count, 0U);
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], 30, 1e-9);
}

TEST(LeavingThePath, GivesAwayWhatWasPlannedMeanwhile) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  const ServoProgress known = bench.progress();
  bench.planner.set_override(50);
  bench.follower().leave();
  bench.planner.step(known);  // continues what is left already
  bench.cycles_without_planner(1000);
  EXPECT_FALSE(bench.record.back().moving);
  EXPECT_LT(bench.record.back().position[0], 25);
}

TEST(LeavingThePath, TellsHowFarTheJointsAreFromIt) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  const double left_at = bench.record.back().position[0];
  bench.follower().leave();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  const auto& rest = bench.record.back().position;
  EXPECT_NEAR(bench.planner.distance_to_path({rest.data(), 3}), rest[0] - left_at, 1e-9);
}

TEST(LeavingThePath, EndsForGoodWhenTheQueueIsEmptied) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  bench.follower().leave();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  bench.planner.clear();
  EXPECT_FALSE(bench.planner.off_path());
  const auto rest = bench.record.back().position;
  bench.builder.restart({rest.data(), 3}, {});
  Move move;
  move.id = 2;
  move.feed_mm_s = 100;
  move.geometry = LineGeometry{bench.builder.end_pose(), {{0, 0, 0}, {0, 0, 1}}};
  ASSERT_TRUE(bench.queue(move));
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_NEAR(bench.record.back().position[0], 0, 1e-9);
}

TEST(LeavingThePath, IsRetracedByWayOfWhereItWasLeft) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  const Setpoint left = bench.record.back();
  bench.follower().leave();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  EXPECT_NEAR(bench.turn_back(5), 5, 1e-9);
  EXPECT_FALSE(bench.planner.off_path());
  bench.planner.command(PathCommand::Retrace);
  const std::size_t begin = bench.record.size();
  ASSERT_TRUE(bench.run());
  EXPECT_TRUE(bench.planner.retraced(bench.progress()));
  double nearest = 1;
  for (std::size_t i = begin; i < bench.record.size(); ++i) {
    nearest = std::min(nearest, std::abs(bench.record[i].position[0] - left.position[0]));
  }
  EXPECT_LT(nearest, 1e-6) << "it rests there in between";
  const double share = 30 / std::hypot(30.0, 20.0);
  EXPECT_NEAR(bench.record.back().position[0], left.position[0] - 5 * share, 1e-6);
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), 1U);
  EXPECT_NEAR(bench.record.back().position[0], 30, 1e-9);
  expect_within_limits(bench);
}

TEST(LeavingThePath, EndsARetrace) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 20);
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  ASSERT_GT(bench.turn_back(15), 0);
  bench.planner.command(PathCommand::Retrace);
  for (int i = 0; i < 150; ++i) bench.cycle();
  const double left_at = bench.record.back().position[0];
  bench.follower().leave();
  ASSERT_TRUE(bench.run(2000));
  EXPECT_TRUE(bench.planner.retraced(bench.progress()));
  ASSERT_TRUE(bench.planner.off_path());
  EXPECT_LT(bench.record.back().position[0], left_at);
  ASSERT_TRUE(bench.planner.rejoin({bench.record.back().position.data(), 3}));
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), 1U);
  EXPECT_NEAR(bench.record.back().position[0], 30, 1e-9);
  expect_within_limits(bench);
}

TEST(LeavingThePath, IsRetracedFromTheWayBackToItToo) {
  PlannerBench bench(mill());
  queue_line(bench);
  run_to(bench, 10);
  const Setpoint left = bench.record.back();
  bench.follower().leave();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  ASSERT_TRUE(bench.planner.rejoin({bench.record.back().position.data(), 3}));
  bench.planner.command(PathCommand::Run);
  for (int i = 0; i < 100; ++i) bench.cycle();
  bench.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench.run(2000));
  ASSERT_GT(bench.record.back().position[0], left.position[0] + 0.1) << "still on the way";
  EXPECT_NEAR(bench.turn_back(5), 5, 1e-9);
  bench.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench.run());
  bench.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench.run());
  EXPECT_EQ(bench.moves_done(), 1U);
  EXPECT_NEAR(bench.record.back().position[0], 30, 1e-9);
  expect_within_limits(bench);
}

/// Kinematics that are right until they are told otherwise, and then wrong in one way.
class Unfaithful final : public Kinematics {
 public:
  enum class Fault { None, NoSolution, NotANumber, Lie, Noise };
  explicit Unfaithful(std::shared_ptr<const Kinematics> truth) : truth_(std::move(truth)) {}
  void begin(Fault fault, double amount) { fault_ = fault, amount_ = amount; }

  [[nodiscard]] std::size_t joint_count() const noexcept override { return truth_->joint_count(); }
  [[nodiscard]] JointType joint_type(std::size_t joint) const noexcept override { return truth_->joint_type(joint); }
  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    truth_->forward(joints, tool, pose);
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                                         std::span<double> joints) const noexcept override {
    if (fault_ == Fault::NoSolution) return KinematicsStatus::OutOfReach;
    const KinematicsStatus status = truth_->inverse(pose, tool, seed, joints);
    if (fault_ == Fault::NotANumber) joints[1] = std::numeric_limits<double>::quiet_NaN();
    if (fault_ == Fault::Lie) joints[0] += amount_;
    if (fault_ == Fault::Noise) {
      for (double& joint : joints) joint += amount_ * std::sin(1e5 * ++calls_);
    }
    return status;
  }
  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> rows) const noexcept override {
    truth_->jacobian(joints, tool, rows);
  }

 private:
  std::shared_ptr<const Kinematics> truth_;
  Fault fault_ = Fault::None;
  double amount_ = 0;
  mutable double calls_ = 0;
};

class KinematicsThatErr : public ::testing::TestWithParam<std::tuple<Unfaithful::Fault, unsigned>> {};

TEST_P(KinematicsThatErr, LeaveTheJointsToComeToRestWithinTheirLimits) {
  const auto [fault, seed] = GetParam();
  PlannerModel model = mill(seed % 2 == 0 ? 10000 : 50000);
  const auto kinematics = std::make_shared<Unfaithful>(model.kinematics);
  model.kinematics = kinematics;
  PlannerBench bench(model);
  (void)queue_program(bench, seed);
  std::mt19937 random(seed);
  bench.planner.command(PathCommand::Run);
  for (int wait = std::uniform_int_distribution(1, 600)(random); wait > 0; --wait) bench.cycle();
  while (!bench.record.back().moving && bench.planner.moves_left() > 0) bench.cycle();
  ASSERT_TRUE(bench.record.back().moving) << "the program was done before anything failed";
  kinematics->begin(fault, std::pow(10, std::uniform_real_distribution(-2.0, 2.0)(random)));
  const int needed = cycles_to_rest(bench.record.back(), model);
  bench.cycles_without_planner(needed + 2);
  EXPECT_FALSE(bench.record.back().moving);
  const PathDeparture departure = bench.progress().departure;
  EXPECT_EQ(departure.count, 1U);
  using Cause = PathDeparture::Cause;
  EXPECT_EQ(departure.cause, fault == Unfaithful::Fault::NoSolution   ? Cause::NoSolution
                             : fault == Unfaithful::Fault::NotANumber ? Cause::NotANumber
                                                                      : Cause::Jump);
  if (fault == Unfaithful::Fault::NotANumber) {
    EXPECT_EQ(departure.joint, 1U);
  }
  expect_within_limits(bench);
}

INSTANTIATE_TEST_SUITE_P(Seeds, KinematicsThatErr,
                         ::testing::Combine(::testing::Values(Unfaithful::Fault::NoSolution,
                                                              Unfaithful::Fault::NotANumber, Unfaithful::Fault::Lie,
                                                              Unfaithful::Fault::Noise),
                                            test::seeds(25)));

}  // namespace
}  // namespace rmac
