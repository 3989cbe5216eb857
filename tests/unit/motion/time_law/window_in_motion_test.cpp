// Windows that go on from a machine in motion: from wherever a law has it, there is one behind.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "joins/path_joiner.hpp"
#include "seeds.hpp"
#include "time_law/law_check.hpp"
#include "time_law/window.hpp"
#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// Lines through these places, joined as the planner joins them.
struct JoinedLines {
  PathSegments segments;
  std::vector<double> starts;
  double end = 0;

  JoinedLines(const std::vector<JointLimits>& joints, const std::vector<Vector>& places, Move move) {
    test::PlannerBench bench(test::mill());
    bench.builder.restart(std::vector<double>(places[0].begin(), places[0].end()), {});
    PathJoiner joiner(joints, 1e-3);
    for (std::size_t i = 0; i + 1 < places.size(); ++i) {
      move.id = static_cast<std::int64_t>(i);
      move.geometry = LineGeometry{{places[i], {0, 0, 1}}, {places[i + 1], {0, 0, 1}}};
      const auto built = bench.builder.build(move);
      for (const auto& segment : built.value()) joiner.add(segment);
    }
    while (joiner.ready()) joiner.advance(segments);
    while (!joiner.empty()) joiner.release(segments);
    for (const auto& segment : segments) {
      starts.push_back(end);
      end += segment->length();
    }
  }
  [[nodiscard]] PathView path() const { return PathView(segments, starts); }
};

PathState state_at(const std::vector<LawPiece>& law, double t) {
  auto piece = law.begin();
  while (piece + 1 != law.end() && (piece + 1)->t0 <= t) ++piece;
  return piece->at(t - piece->t0);
}

/// From rest to `first`; then, from each state of that law at which the machine moves and may go on moving, to `ahead`
/// behind it.
void goes_on_from_everywhere(const JoinedLines& lines, const std::vector<JointLimits>& joints, double first,
                             double ahead) {
  const auto law = plan_window(lines.path(), joints, {{0, 0, 0}, first, {}, nullptr, false, true});
  ASSERT_TRUE(law);
  const double time = law->back().t0 + law->back().duration;
  for (double t = 0.05 * time; t < 0.95 * time; t += time / 23) {
    const PathState from = state_at(*law, t);
    // So near its rest nothing keeps it from standing still: its acceleration ends too late.
    if (from.a < 0 && from.v * joints[0].max_jerk < 2 * from.a * from.a) continue;
    const double to = std::max(first, std::min(from.s + ahead, lines.end));
    const auto next = plan_window(lines.path(), joints, {from, to, {}, &*law, true, true});
    ASSERT_TRUE(next) << "at " << from.s << " mm, " << from.v << " mm/s, " << from.a << " mm/s²";
    const FeedRule programmed;
    EXPECT_LE(check_law(lines.path(), joints, *next, &programmed).worst, 1);
  }
}

class WindowInMotion : public testing::TestWithParam<unsigned> {
 protected:
  double uniform(double low, double high) { return std::uniform_real_distribution<>(low, high)(random_); }
  double logarithmic(double low, double high) { return std::exp(uniform(std::log(low), std::log(high))); }

 private:
  std::mt19937 random_{GetParam()};
};

// Its state while it brakes is at the very bound, and no law behind it may exceed that by rounding.
TEST_P(WindowInMotion, GoesOnWhileItBrakesAsHardAsItsPathMay) {
  auto joints = test::mill(logarithmic(10'000, 90'000)).joints;
  for (JointLimits& joint : joints) joint.max_acceleration = uniform(500, 4000);
  Move move;
  move.feed_mm_s = uniform(20, 90);
  move.tolerance_mm = 0.05;
  move.accel_rise_mm_s2 = uniform(50, 500);
  move.accel_fall_mm_s2 = uniform(50, 500);
  const double turn = uniform(0.3, 2), far = uniform(0, 2 * std::numbers::pi);
  const Vector corner{30 * std::cos(far), 30 * std::sin(far), uniform(-5, 5)};
  const Vector end{corner[0] + 15 * std::cos(far + turn), corner[1] + 15 * std::sin(far + turn), 0};
  goes_on_from_everywhere({joints, {{0, 0, 0}, corner, end}, move}, joints, 15, 20);
}

// In corners one joint's jerk may peak between two nodes of the law's grid, while another's is at its bound there.
TEST_P(WindowInMotion, GoesOnAlongAZigzag) {
  auto joints = test::mill(logarithmic(10'000, 90'000)).joints;
  for (JointLimits& joint : joints) joint.max_acceleration = uniform(1000, 5000);
  Move move;
  move.feed_mm_s = uniform(20, 60);
  move.tolerance_mm = logarithmic(0.01, 0.05);
  const double height = logarithmic(0.02, 0.3), pitch = logarithmic(0.1, 0.5), slope = uniform(0, 2 * std::numbers::pi);
  std::vector<Vector> places;
  for (int i = 0; i <= 80; ++i) {
    const double side = i % 2 == 0 ? -height : height;
    places.push_back({i * pitch * std::cos(slope) - side * std::sin(slope),
                      i * pitch * std::sin(slope) + side * std::cos(slope), 0});
  }
  const JoinedLines lines(joints, places, move);
  goes_on_from_everywhere(lines, joints, 0.15 * lines.end, 0.15 * lines.end);
}

/// A law of a zigzag, checked against limits that are a little lower than those that it was made for.
TEST_P(WindowInMotion, IsToldWhereItIsMostOverBetweenItsNodes) {
  auto joints = test::mill(logarithmic(10'000, 90'000)).joints;
  Move move;
  move.feed_mm_s = uniform(20, 60);
  move.tolerance_mm = 0.03;
  std::vector<Vector> places;
  for (int i = 0; i <= 40; ++i) places.push_back({0.3 * i, i % 2 == 0 ? -0.1 : 0.1, 0});
  const JoinedLines lines(joints, places, move);
  const auto law = plan_window(lines.path(), joints, {{0, 0, 0}, lines.end, {}, nullptr, false, true});
  ASSERT_TRUE(law);
  for (JointLimits& joint : joints) joint.max_acceleration /= 1.05, joint.max_jerk /= 1.05;
  const LawExcess excess = check_law(lines.path(), joints, *law, nullptr);
  ASSERT_EQ(excess.peaks.size(), law->size());
  int peaks = 0;
  for (std::size_t i = 0; i < law->size(); ++i) {
    if (excess.by_piece[i] <= 1) {
      EXPECT_FALSE(excess.peaks[i]) << i;
    }
    if (!excess.peaks[i]) continue;
    ++peaks;
    const LawPiece& piece = (*law)[i];
    const double s = *excess.peaks[i];
    ASSERT_GT(s, piece.start.s);
    ASSERT_LT(s, piece.at(piece.duration).s);
    double low = 0, high = piece.duration;
    for (int n = 0; n < 60; ++n) (piece.at(0.5 * (low + high)).s < s ? low : high) = 0.5 * (low + high);
    const PathState at = piece.at(high);
    JointPoint point;
    ASSERT_EQ(lines.path().derivatives(s, 1, point), KinematicsStatus::Ok);
    const double path_jerk = piece.kind == LawPiece::Kind::Jerk ? piece.slope : piece.slope * at.v;
    double most = 0;
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const double acceleration = point.d[2][j] * at.v * at.v + point.d[1][j] * at.a;
      const double jerk =
          point.d[3][j] * std::pow(at.v, 3) + 3 * point.d[2][j] * at.v * at.a + point.d[1][j] * path_jerk;
      most = std::max({most, std::abs(acceleration) / joints[j].max_acceleration, std::abs(jerk) / joints[j].max_jerk});
    }
    EXPECT_NEAR(most, excess.by_piece[i], 0.01) << "piece " << i;
  }
  EXPECT_GT(peaks, 5);
}

INSTANTIATE_TEST_SUITE_P(Seeds, WindowInMotion, test::seeds(24));
/// Zigzags on which states have no law behind them where bounds are kept at nodes alone.
INSTANTIATE_TEST_SUITE_P(PeaksBetweenNodes, WindowInMotion, testing::Values(119U, 131U, 155U));

}  // namespace
}  // namespace rmac
