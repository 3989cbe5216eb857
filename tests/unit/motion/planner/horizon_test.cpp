// How far ahead motion is planned, and why it is not further, cycle by cycle.
#include "rmac/motion/follower/horizon.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "seeds.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {

void PrintTo(HorizonLimit limit, std::ostream* out) {
  *out << to_string(limit);
}

namespace {

using test::mill;
using test::PlannerBench;

constexpr double kPeriod_s = 0.001;

/// The tool of a mill on its way along fine lines, as a CAM system makes them of a curve.
class Horizons : public ::testing::TestWithParam<unsigned> {
 protected:
  Horizons() { bench_.builder.restart(std::vector<double>{0, 0, 0}, {}); }

  /// The next line along a curve that bends to and fro.
  void queue_fine_line(double length_mm = 0.2) {
    direction_ += 0.03 * std::sin(0.01 * static_cast<double>(lines_));
    queue_line({x_ + length_mm * std::cos(direction_), y_ + length_mm * std::sin(direction_)}, 0.01);
    if (std::hypot(x_, y_) > 40) direction_ += std::numbers::pi / 2;
  }
  void queue_line(std::array<double, 2> to, double tolerance_mm = 0, double feed_mm_s = 50) {
    Move move;
    move.id = ++lines_;
    move.feed_mm_s = feed_mm_s;
    move.tolerance_mm = tolerance_mm;
    move.geometry = LineGeometry{{{x_, y_, 0}, {0, 0, 1}}, {{to[0], to[1], 0}, {0, 0, 1}}};
    ASSERT_TRUE(bench_.queue(move));
    x_ = to[0], y_ = to[1];
  }
  Horizon cycle() {
    bench_.cycle();
    return now();
  }
  Horizon now() { return bench_.follower().horizon(); }
  bool moving() const { return !bench_.record.empty() && bench_.record.back().moving; }
  int any(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  /// Cycles until the machine rests, if the planner hangs from now on.
  int cycles_to_rest() {
    int cycles = 0;
    for (; moving(); ++cycles) bench_.cycles_without_planner(1);
    return cycles;
  }

  std::mt19937 random_{GetParam()};
  PlannerBench bench_{mill(20000)};

 private:
  std::int64_t lines_ = 0;
  double x_ = 0, y_ = 0, direction_ = 0;
};

TEST_P(Horizons, AreTheTimeUntilTheMachineRestsWithoutItsPlanner) {
  for (int i = 0; i < 200; ++i) queue_fine_line();
  bench_.planner.command(PathCommand::Run);
  for (int i = any(1, 700); i > 0; --i) cycle();
  const Horizon horizon = now();
  ASSERT_TRUE(moving());
  EXPECT_EQ(cycles_to_rest(), static_cast<int>(std::ceil(horizon.s / kPeriod_s - 1e-9)));
  EXPECT_EQ(now().s, 0);
}

TEST_P(Horizons, OfAMachineThatBrakesBesideItsPathAreTheTimeThatItTakes) {
  for (int i = 0; i < 200; ++i) queue_fine_line();
  bench_.planner.command(PathCommand::Run);
  for (int i = any(50, 700); i > 0; --i) cycle();
  bench_.follower().leave();
  bench_.cycles_without_planner(1);
  const Horizon horizon = now();
  EXPECT_EQ(horizon.limit, HorizonLimit::Stop);
  EXPECT_GT(horizon.s, 0);
  EXPECT_EQ(cycles_to_rest(), static_cast<int>(std::ceil(horizon.s / kPeriod_s - 1e-9)));
}

TEST_P(Horizons, AreLongEnoughWhileTheQueueHoldsMore) {
  int queued = 0;
  for (; queued < 1000; ++queued) queue_fine_line(0.05 + 0.01 * any(0, 20));
  bench_.planner.command(PathCommand::Run);
  int cycles = 0;
  for (Horizon horizon = cycle(); horizon.s > 0 || cycles == 0; horizon = cycle(), ++cycles) {
    if (horizon.limit == HorizonLimit::Queue) continue;
    ASSERT_GE(horizon.s, kPromisedHorizon_s) << to_string(horizon.limit) << " in cycle " << bench_.record.size();
    ASSERT_TRUE(horizon.limit == HorizonLimit::Enough || horizon.limit == HorizonLimit::HeldBack)
        << to_string(horizon.limit);
    ASSERT_LT(bench_.record.size(), 100'000U);
  }
  EXPECT_EQ(now().limit, HorizonLimit::Queue);
  EXPECT_EQ(bench_.planner.moves_left(), 0U);
}

TEST_P(Horizons, EndWithTheQueueOfAClientThatIsTooSlow) {
  bench_.planner.command(PathCommand::Run);
  const int pause = any(20, 60);
  int moved = 0, rests = 0;
  for (int i = 0; i < 4000; ++i) {
    if (i % pause == 0) queue_fine_line(0.5);  // 10 ms at the programmed feed
    const bool moved_before = moving();
    const Horizon horizon = cycle();
    moved += moving() ? 1 : 0;
    rests += moved_before && !moving() ? 1 : 0;
    if (horizon.s < kPromisedHorizon_s) {
      ASSERT_EQ(horizon.limit, HorizonLimit::Queue) << "in cycle " << i << ", " << horizon.s << " s ahead";
    }
  }
  EXPECT_GT(moved, 1000);
}

TEST_P(Horizons, AreThePlannersOwnFaultWhereItHangs) {
  for (int i = 0; i < 1000; ++i) queue_fine_line();
  bench_.planner.command(PathCommand::Run);
  for (int i = any(1, 700); i > 0; --i) cycle();
  while (moving()) {
    bench_.cycles_without_planner(1);
    EXPECT_EQ(now().limit, now().s < kPromisedHorizon_s ? HorizonLimit::Planning : HorizonLimit::Enough);
  }
}

TEST_P(Horizons, EndWithACommandToStopUntilMotionBeginsAgain) {
  for (int i = 0; i < 1000; ++i) queue_fine_line();
  EXPECT_EQ(cycle().limit, HorizonLimit::Stop) << "not started";
  bench_.planner.command(PathCommand::Run);
  for (int i = any(10, 700); i > 0; --i) cycle();
  bench_.planner.command(PathCommand::Stop);
  do {
    EXPECT_EQ(cycle().limit, HorizonLimit::Stop);
  } while (moving());
  EXPECT_EQ(now().s, 0);
  bench_.planner.command(PathCommand::Run);
  EXPECT_EQ(cycle().limit, HorizonLimit::Enough);
}

TEST_P(Horizons, EndWithAnOverrideOfZero) {
  for (int i = 0; i < 1000; ++i) queue_fine_line();
  bench_.planner.command(PathCommand::Run);
  for (int i = any(10, 700); i > 0; --i) cycle();
  bench_.planner.set_override(0);
  do {
    EXPECT_EQ(cycle().limit, HorizonLimit::Override);
  } while (moving());
  EXPECT_EQ(cycle().limit, HorizonLimit::Override);
  bench_.planner.set_override(100);
  cycle();
  EXPECT_EQ(now().limit, HorizonLimit::Enough);
}

TEST_P(Horizons, EndAtTheRestOfASingleMoveAndOfWhatNeedsRestBehindTheQueue) {
  for (int i = 1; i < 5; ++i) queue_line({static_cast<double>(any(5, 9) * i), 0});
  bench_.planner.command(PathCommand::RunOne);
  do {
    EXPECT_EQ(cycle().limit, HorizonLimit::Rest);
  } while (moving());
  bench_.planner.command(PathCommand::Run);
  bench_.planner.rest_follows(true);
  while (cycle(), moving()) EXPECT_NE(now().limit, HorizonLimit::Queue);
  EXPECT_EQ(now().limit, HorizonLimit::Rest);
  bench_.planner.rest_follows(false);
  cycle();  // it hears of it between two cycles
  EXPECT_EQ(cycle().limit, HorizonLimit::Queue);
}

TEST_P(Horizons, GoOnBehindACornerInWhichThePathRests) {
  for (int i = 1; i < 9; ++i)
    queue_line({static_cast<double>(any(5, 9)), static_cast<double>(3 * (i % 2 == 0 ? -i : i))});
  bench_.planner.command(PathCommand::Run);
  while (cycle().limit != HorizonLimit::Queue) {
    ASSERT_GE(now().s, kPromisedHorizon_s);
    ASSERT_EQ(now().limit, HorizonLimit::Enough);
    ASSERT_LT(bench_.record.size(), 100'000U);
  }
}

TEST_P(Horizons, EndWithTheWayBack) {
  for (int i = 0; i < 1000; ++i) queue_fine_line();
  bench_.planner.command(PathCommand::Run);
  for (int i = any(300, 700); i > 0; --i) cycle();
  bench_.planner.command(PathCommand::Stop);
  ASSERT_TRUE(bench_.run());
  ASSERT_GT(bench_.turn_back(any(1, 4)), 0);
  bench_.planner.command(PathCommand::Retrace);
  ASSERT_TRUE(bench_.run());
  EXPECT_EQ(now().limit, HorizonLimit::Rest);
  bench_.planner.command(PathCommand::Run);
  ASSERT_TRUE(bench_.run());
  EXPECT_EQ(now().limit, HorizonLimit::Queue);
}

TEST(HorizonWatch, GivesThePlannerItsTimeWithWhatCameLate) {
  HorizonWatch watch(kPeriod_s);
  watch.step(1, {0.01, HorizonLimit::Queue});
  for (std::int64_t cycle = 2; cycle < 51; ++cycle) {
    watch.step(cycle, {0.01, HorizonLimit::Planning});
    ASSERT_EQ(watch.now().limit, HorizonLimit::Queue) << cycle;
  }
  watch.step(51, {0.01, HorizonLimit::Planning});
  EXPECT_EQ(watch.now().limit, HorizonLimit::Planning);
}

TEST(HorizonWatch, GivesThePlannerNoTimeWhereItsHorizonWasLongEnough) {
  HorizonWatch watch(kPeriod_s);
  watch.step(1, {0.01, HorizonLimit::Queue});
  watch.step(2, {0.051, HorizonLimit::Planning});
  EXPECT_EQ(watch.now().limit, HorizonLimit::Enough);
  watch.step(3, {0.049, HorizonLimit::Planning});
  EXPECT_EQ(watch.now().limit, HorizonLimit::Planning);
}

INSTANTIATE_TEST_SUITE_P(Seeds, Horizons, test::seeds(6));

}  // namespace
}  // namespace rmac
