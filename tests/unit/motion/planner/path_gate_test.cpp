#include "rmac/motion/ports/path_gate.hpp"

#include <gtest/gtest.h>

#include <deque>
#include <random>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac {
namespace {

/// Lets everything through, each segment after it was asked for a few times in vain.
class SlowGate final : public PathGate {
 public:
  explicit SlowGate(std::uint64_t seed) : random_(seed) {}

  void ask(std::shared_ptr<const PathSegment>) override { waits_.push_back(static_cast<int>(random_() % 5)); }
  [[nodiscard]] Answer answer() override {
    if (waits_.empty() || waits_.front()-- > 0) return {};
    waits_.pop_front();
    return {Answer::Kind::Passes, 0};
  }
  void forget() override { waits_.clear(); }
  [[nodiscard]] std::size_t ahead() const noexcept override { return 4; }

 private:
  std::mt19937_64 random_;
  std::deque<int> waits_;
};

/// Ten lines with corners that are not rounded.
bool zigzag(std::uint64_t seed, test::PlannerBench& bench) {
  std::mt19937_64 random(seed);
  const auto uniform = [&] { return std::uniform_real_distribution<double>(-45, 45)(random); };
  Vector at{0, 0, 0};
  for (std::int64_t id = 1; id <= 10; ++id) {
    const Vector to{uniform(), uniform(), uniform()};
    if (!bench.queue({.id = id, .geometry = LineGeometry{{at, test::kUp}, {to, test::kUp}}, .feed_mm_s = 80}))
      return false;
    at = to;
  }
  bench.planner.command(PathCommand::Run);
  return bench.run();
}

// Red when a window goes on behind a corner that was laid while it was looked for.
TEST(PathGate, ThatTakesItsTimeChangesNeitherThePathNorItsLimits) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    test::PlannerBench free(test::mill()), gated(test::mill());
    SlowGate gate(seed);
    gated.planner.set_gate(&gate);
    ASSERT_TRUE(zigzag(seed, free) && zigzag(seed, gated)) << "seed " << seed;
    EXPECT_EQ(gated.follower().departure().count, 0U) << "seed " << seed;
    EXPECT_EQ(gated.moves_done(), 10U) << "seed " << seed;
    const auto peaks = gated.peaks();
    EXPECT_LE(peaks.velocity, 1.001) << "seed " << seed;
    EXPECT_LE(peaks.acceleration, 1.001) << "seed " << seed;
    EXPECT_LE(peaks.jerk, 1.001) << "seed " << seed << ", cycle " << peaks.jerk_cycle;
    EXPECT_EQ(gated.record.back().position, free.record.back().position) << "seed " << seed;
    gated.planner.set_gate(nullptr);
  }
}

}  // namespace
}  // namespace rmac
