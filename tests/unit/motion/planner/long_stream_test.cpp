// A stream of moves that goes on and on: the machine never rests in it, and far along it nothing is coarser than at its
// beginning.
#include <gtest/gtest.h>

#include <numbers>

#include "seeds.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

using test::mill;
using test::PlannerBench;

constexpr double kFeed_mm_s = 200;

/// Splines of ten poles that follow each other with equal tangent and curvature.
class SplineStream {
 public:
  explicit SplineStream(unsigned seed) : random_(seed) {}

  Move next() {
    std::vector<std::vector<double>> poles;
    for (int i = 0; i < 10; ++i) poles.push_back({uniform(-38, 38), uniform(-38, 38), uniform(-10, 10)});
    if (before_.empty()) poles[0] = {0, 0, 0};
    // Three poles on the tangent, the second distance twice the first: no curvature there, whatever the degree.
    if (!before_.empty()) {
      const auto& end = before_.back();
      const auto& inner = before_[before_.size() - 2];
      for (std::size_t c = 0; c < 3; ++c) {
        poles[0][c] = end[c], poles[1][c] = 2 * end[c] - inner[c], poles[2][c] = 4 * end[c] - 3 * inner[c];
      }
    }
    const double turn = uniform(0, 2 * std::numbers::pi);
    const double step[3] = {4 * std::cos(turn), 4 * std::sin(turn), 0};
    for (std::size_t c = 0; c < 3; ++c) poles[8][c] = poles[9][c] - step[c], poles[7][c] = poles[9][c] - 3 * step[c];
    before_ = poles;
    NurbsGeometry geometry;
    geometry.curve.degree = std::uniform_int_distribution<int>(3, 5)(random_);
    const int spans = 10 - geometry.curve.degree;
    for (int i = 0; i < 10 + geometry.curve.degree + 1; ++i)
      geometry.curve.knots.push_back(std::clamp(i - geometry.curve.degree, 0, spans));
    geometry.curve.points = std::move(poles);
    Move move;
    move.id = ++id_;
    move.feed_mm_s = kFeed_mm_s;
    move.tolerance_mm = 0.01;
    move.geometry = std::move(geometry);
    return move;
  }

 private:
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }

  std::mt19937 random_;
  std::vector<std::vector<double>> before_;
  std::int64_t id_ = 0;
};

class LongStream : public ::testing::TestWithParam<unsigned> {};

TEST_P(LongStream, NeverRestsBeforeItsEnd) {
  constexpr std::size_t kMoves = 12;
  SplineStream stream(GetParam());
  PlannerBench bench(mill(50000));
  bench.builder.restart(std::vector<double>{0, 0, 0}, {});
  Move move = stream.next();
  std::size_t queued = 0, rests = 0, done = 0;
  bench.planner.command(PathCommand::Run);
  bool moving = false;
  while (done < kMoves) {
    for (; queued < kMoves && bench.planner.moves_left() < 8; ++queued, move = stream.next())
      ASSERT_TRUE(bench.queue(move)) << "move " << move.id;
    bench.cycle();
    const Setpoint& setpoint = bench.record.back();
    done += setpoint.moves_done;
    if (moving && !setpoint.moving && done < kMoves) ++rests;
    moving = setpoint.moving;
    ASSERT_LT(bench.record.size(), 1'000'000U);
  }
  EXPECT_EQ(rests, 0U);
  const auto peaks = bench.peaks();
  EXPECT_LE(peaks.velocity, 1.0005);
  EXPECT_LE(peaks.acceleration, 1.0005);
  EXPECT_LE(peaks.jerk, 1.0005) << "in cycle " << peaks.jerk_cycle;
}

// 41 and 47: a window found no plan from the state where it was to begin, and from that state alone.
INSTANTIATE_TEST_SUITE_P(Seeds, LongStream, ::testing::Values(1U, 2U, 3U, 41U, 47U));

/// Laps of a circle about (20, 0), which begin at the origin.
constexpr double kRadius_mm = 20;

class LongWay : public ::testing::TestWithParam<unsigned> {
 protected:
  void queue_laps(std::size_t count) {
    Move move;
    move.feed_mm_s = kFeed_mm_s;
    ArcGeometry lap;
    lap.center = {kRadius_mm, 0, 0};
    lap.closed = true;
    lap.start = lap.end = {{0, 0, 0}, {0, 0, 1}};
    move.geometry = lap;
    for (std::size_t i = 0; i < count; ++i) {
      move.id = static_cast<std::int64_t>(++laps_);
      ASSERT_TRUE(bench_.queue(move));
    }
  }
  int cycles(int least, int most) { return std::uniform_int_distribution<int>(least, most)(random_); }
  void run_for(int cycles) {
    for (int i = 0; i < cycles; ++i) bench_.cycle();
  }

  std::mt19937 random_{GetParam()};
  PlannerBench bench_{mill(50000)};
  std::size_t laps_ = 0;
};

/// The path length that plans count has its origin moved after the tool again and again; nothing of it shows.
TEST_P(LongWay, IsAsExactAtItsEndAsAtItsBeginning) {
  queue_laps(60);  // 7.5 m
  while (bench_.planner.moves_left() > 0) {
    bench_.planner.command(cycles(0, 2) == 0 ? PathCommand::RunOne : PathCommand::Run);
    run_for(cycles(1, 4000));
    bench_.planner.command(PathCommand::Stop);
    ASSERT_TRUE(bench_.run(20'000));
    if (cycles(0, 1) == 0 || bench_.turn_back(cycles(1, 1500)) == 0) continue;
    bench_.planner.command(PathCommand::Retrace);
    run_for(cycles(1, 4000));
    bench_.planner.command(PathCommand::Stop);
    ASSERT_TRUE(bench_.run(20'000));
  }
  std::int64_t last_done = 0;
  for (const Setpoint& setpoint : bench_.record) {
    const double turned = setpoint.s_mm / kRadius_mm;  // clockwise or not
    ASSERT_NEAR(setpoint.position[0], kRadius_mm * (1 - std::cos(turned)), 1e-9);
    ASSERT_NEAR(std::abs(setpoint.position[1]), std::abs(kRadius_mm * std::sin(turned)), 1e-9);
    last_done += setpoint.moves_done;
    ASSERT_LE(setpoint.move_id, last_done + 1);
  }
  EXPECT_EQ(bench_.moves_done(), laps_);
  const auto peaks = bench_.peaks();
  EXPECT_LE(peaks.velocity, 1.0005);
  EXPECT_LE(peaks.acceleration, 1.0005);
  EXPECT_LE(peaks.jerk, 1.0005) << "in cycle " << peaks.jerk_cycle;
}

INSTANTIATE_TEST_SUITE_P(Seeds, LongWay, test::seeds(4));

}  // namespace
}  // namespace rmac
