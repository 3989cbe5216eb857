#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <random>

#include "gateway/collision/ahead/clear_way.hpp"
#include "gateway/collision/ahead/collision_guard.hpp"
#include "gateway/threads/sanitized.hpp"
#include "unit/gateway/collision/shapes.hpp"
#include "unit/motion/planner/planner_bench.hpp"

// The planner behind the guard, on machines whose distances are known in closed form: a ball that X, Y and Z carry, and
// one obstacle on the table.

namespace rmac::gateway {
namespace {

using Eigen::Vector3d;
using testing::HasSubstr;

constexpr double kBall_mm = 2;

struct Block {
  enum class Kind { Box, BoxMesh, Ball } kind = Kind::Box;
  Vector3d at{0, 0, 0}, half{1, 1, 1};  ///< of a ball the first is its radius

  /// Of the ball that the spindle carries, from this.
  [[nodiscard]] double gap(const Vector3d& tip) const {
    if (kind == Kind::Ball) return (tip - at).norm() - half[0] - kBall_mm;
    const Vector3d beyond = (tip - at).cwiseAbs() - half;
    return beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0) - kBall_mm;
  }
  [[nodiscard]] Solid solid() const {
    if (kind == Kind::Ball) return Solid(Convex::sphere(half[0]));
    return kind == Kind::Box ? Solid(Convex::box(half)) : Solid(test::box_mesh(half, 3));
  }
};

double uniform(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// Lines with rounded corners, short ones too, arcs and positioning moves, one behind the other.
std::vector<Move> program(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::vector<Move> moves;
  Vector at{0, 0, 0};
  const double tolerance = std::array{0.0, 0.01, 0.3}[random() % 3];
  for (std::int64_t id = 1; id <= 12; ++id) {
    const double way = random() % 3 == 0 ? 2 : 40;
    Vector to = at;
    for (double& c : to) c = std::clamp(c + uniform(random, -way, way), -45.0, 45.0);
    Move move{.id = id,
              .geometry = LineGeometry{{at, rmac::test::kUp}, {to, rmac::test::kUp}},
              .feed_mm_s = uniform(random, 5, 120)};
    move.tolerance_mm = tolerance;
    const auto kind = random() % 6;
    if (kind == 0) move.geometry = PathTargetGeometry{{to, rmac::test::kUp}};
    if (kind == 1) move.geometry = JointTargetGeometry{{to[0], to[1], to[2]}};
    if (kind == 2) {
      const Vector via{(at[0] + to[0]) / 2 + 1, (at[1] + to[1]) / 2 - 1, (at[2] + to[2]) / 2 + 0.5};
      move.geometry = Arc3Geometry{via, {at, rmac::test::kUp}, {to, rmac::test::kUp}};
    }
    moves.push_back(move);
    at = to;
  }
  return moves;
}

LinkChain slides() {
  const std::vector<std::string> chain{"base", "X", "Y", "Z"}, names{"X", "Y", "Z"};
  const std::vector<std::pair<double, double>> limits(3, {-50, 50});
  return LinkChain::make(*rmac::test::mill().kinematics, chain, names, limits).value();
}

std::shared_ptr<ClearWay> way_past(const Block& block, double clearance,
                                   SceneBody::Kind kind = SceneBody::Kind::Fixture) {
  std::vector<SceneBody> bodies;
  bodies.push_back({kind, "clamp", 0, block.solid(), Eigen::Isometry3d(Eigen::Translation3d(block.at))});
  bodies.push_back(
      {SceneBody::Kind::Machine, "ball", 3, Solid(Convex::sphere(kBall_mm)), Eigen::Isometry3d::Identity()});
  return std::make_shared<ClearWay>(slides(), std::move(bodies), Frame{}, clearance);
}

class GuardedBench {
 public:
  explicit GuardedBench(bool in_thread = false) : guard(in_thread), bench(rmac::test::mill()) {}
  ~GuardedBench() { bench.planner.set_gate(nullptr); }

  void check(const Block& block, double clearance, SceneBody::Kind kind = SceneBody::Kind::Fixture) {
    guard.put_in(way_past(block, clearance, kind));
    guard.set_tool(std::make_shared<const Tool>(Tool{.number = kNoTool}));
    bench.planner.set_gate(&guard);
  }
  /// False where a move cannot be built, or the machine does not come to rest.
  bool run(const std::vector<Move>& moves) {
    for (const Move& move : moves) {
      if (!bench.queue(move)) return false;
    }
    bench.planner.command(PathCommand::Run);
    return bench.run();
  }
  [[nodiscard]] Vector3d tip(std::size_t i) const {
    const auto& q = bench.record[i].position;
    return {q[0], q[1], q[2]};
  }
  [[nodiscard]] Vector3d rests_at() const { return tip(bench.record.size() - 1); }
  [[nodiscard]] double least_gap(const Block& block) const {
    double least = block.gap(Vector3d::Zero());
    for (std::size_t i = 0; i < bench.record.size(); ++i) least = std::min(least, block.gap(tip(i)));
    return least;
  }

  CollisionGuard guard;
  rmac::test::PlannerBench bench;
};

/// Near the path, in the way of it or not, and not where the machine stands at first.
Block planted(std::uint64_t seed, const GuardedBench& free) {
  std::mt19937_64 random(seed ^ 0x9e3779b97f4a7c15U);
  for (;;) {
    Block block;
    block.kind = static_cast<Block::Kind>(random() % 3);
    for (int c = 0; c < 3; ++c) block.half[c] = uniform(random, 0.2, 8);
    block.at = free.tip(random() % free.bench.record.size());
    for (int c = 0; c < 3; ++c) block.at[c] += uniform(random, -12, 12);
    if (block.gap(Vector3d::Zero()) > 2.5) return block;
  }
}

// Red when a stretch is let through unlooked at, when the path that is checked is not the one that is travelled (its
// corners), or when what is clear is planned otherwise for having been checked.
TEST(GuardedPath, RestsApartWhereSomethingIsInTheWayAndIsTheSamePathWhereNothingIs) {
  int held = 0, passed = 0;
  for (std::uint64_t seed = 1; seed <= (kSanitized ? 40 : 200); ++seed) {
    const std::vector<Move> moves = program(seed);
    GuardedBench free;
    if (!free.run(moves)) continue;
    const Block block = planted(seed, free);
    const double clearance = std::array{0.1, 0.5, 2.0}[seed % 3];
    GuardedBench guarded;
    guarded.check(block, clearance);
    ASSERT_TRUE(guarded.run(moves)) << "seed " << seed;
    const double gap = free.least_gap(block);
    if (gap > 1.01 * clearance) {
      ++passed;
      ASSERT_FALSE(guarded.bench.planner.blocked()) << "seed " << seed << ": " << gap;
      ASSERT_EQ(guarded.bench.record.size(), free.bench.record.size()) << "seed " << seed;
      for (std::size_t i = 0; i < free.bench.record.size(); ++i) {
        ASSERT_EQ(guarded.bench.record[i].position, free.bench.record[i].position)
            << "seed " << seed << ", cycle " << i;
      }
    } else if (gap < 0.95 * clearance) {
      ++held;
      ASSERT_TRUE(guarded.bench.planner.blocked()) << "seed " << seed << ": " << gap;
      EXPECT_GE(guarded.least_gap(block), 0.97 * clearance) << "seed " << seed << ": on the way";
      EXPECT_GE(block.gap(guarded.rests_at()), clearance) << "seed " << seed << ": at rest";
      double beside = 1e300;
      for (std::size_t i = 0; i < free.bench.record.size(); ++i) {
        beside = std::min(beside, (guarded.rests_at() - free.tip(i)).norm());
      }
      EXPECT_LT(beside, 0.1) << "seed " << seed << ": it rests on its path";
      const auto& obstacle = guarded.guard.obstacle();
      ASSERT_TRUE(obstacle) << "seed " << seed;
      EXPECT_EQ(obstacle->first, "clamp");
      EXPECT_EQ(obstacle->second, "ball");
    }
  }
  EXPECT_GT(held, kSanitized ? 10 : 20);
  EXPECT_GT(passed, kSanitized ? 10 : 20);
}

// Red when the answers of the thread come to the wrong segments, or the planner goes on without one.
TEST(GuardedPath, IsTheSameWithAThreadBeside) {
  for (std::uint64_t seed = 301; seed <= (kSanitized ? 303 : 320); ++seed) {
    const std::vector<Move> moves = program(seed);
    GuardedBench free;
    if (!free.run(moves)) continue;
    const Block block = planted(seed, free);
    GuardedBench alone(false), beside(true);
    alone.check(block, 0.5);
    beside.check(block, 0.5);
    ASSERT_TRUE(alone.run(moves) && beside.run(moves)) << "seed " << seed;
    ASSERT_EQ(alone.bench.planner.blocked(), beside.bench.planner.blocked()) << "seed " << seed;
    EXPECT_LT((alone.rests_at() - beside.rests_at()).norm(), 1e-9) << "seed " << seed;
    EXPECT_EQ(alone.bench.moves_done(), beside.bench.moves_done()) << "seed " << seed;
  }
}

std::vector<Move> straight(double x, bool positioning = true) {
  Move move{.id = 7, .geometry = PathTargetGeometry{{{x, 0, 0}, rmac::test::kUp}}, .feed_mm_s = 50};
  if (!positioning) move.geometry = LineGeometry{{{0, 0, 0}, rmac::test::kUp}, {{x, 0, 0}, rmac::test::kUp}};
  return {move};
}

TEST(GuardedPath, TellsTheMoveTheBodiesThePlaceAndTheDepth) {
  const Block clamp{Block::Kind::Box, {30, 0, 0}, {5, 50, 50}};
  GuardedBench bench;
  bench.check(clamp, 1);
  ASSERT_TRUE(bench.run(straight(40)));
  const auto& found = bench.guard.obstacle();
  ASSERT_TRUE(found);
  EXPECT_NEAR(bench.rests_at()[0], 30 - 5 - kBall_mm - 1, 0.06);
  EXPECT_EQ(found->move_id, 7);
  EXPECT_NEAR(found->s_mm, 22, 0.06);
  EXPECT_NEAR(found->distance_mm, 1, 0.06);
  EXPECT_NEAR(found->place[0], 25, kBall_mm) << "where they would first meet";
  EXPECT_GT(found->depth_mm, 4);
  EXPECT_THAT(described(*found), HasSubstr("move 7: clamp and ball would meet"));
}

// Red when a jog again and again creeps up to what it was stopped before.
TEST(GuardedPath, ComesNoNearerHoweverOftenItIsTried) {
  const Block clamp{Block::Kind::Box, {30, 0, 0}, {5, 50, 50}};
  GuardedBench bench;
  bench.check(clamp, 1);
  for (int i = 0; i < 20; ++i) {
    const double before = i == 0 ? 0 : bench.rests_at()[0];
    if (i > 0) {
      bench.bench.planner.clear();
      bench.bench.builder.restart(std::vector<double>{before, 0, 0}, Frames{});
    }
    ASSERT_TRUE(bench.run(straight(40)));
    EXPECT_TRUE(bench.bench.planner.blocked());
    EXPECT_GE(clamp.gap(bench.rests_at()), 1) << "try " << i;
  }
  bench.bench.planner.clear();
  bench.bench.builder.restart(std::vector<double>{bench.rests_at()[0], 0, 0}, Frames{});
  ASSERT_TRUE(bench.run(straight(-10)));
  EXPECT_FALSE(bench.bench.planner.blocked()) << "away from it";
  EXPECT_NEAR(bench.rests_at()[0], -10, 1e-9);
}

TEST(GuardedPath, LetsWhatBeginsTooNearPartAndComeNoNearer) {
  const Block clamp{Block::Kind::Box, {8, 0, 0}, {5, 50, 50}};  // 1 mm apart at first
  GuardedBench nearer, away;
  nearer.check(clamp, 3);
  ASSERT_TRUE(nearer.run(straight(1)));
  EXPECT_TRUE(nearer.bench.planner.blocked());
  EXPECT_LT(nearer.rests_at()[0], 0.06) << "a twentieth of what they are apart";
  away.check(clamp, 3);
  ASSERT_TRUE(away.run(straight(-20)));
  EXPECT_FALSE(away.bench.planner.blocked());
}

TEST(GuardedPath, DoesNotMoveWhatMeetsAlready) {
  const Block clamp{Block::Kind::Box, {5, 0, 0}, {5, 50, 50}};
  GuardedBench bench;
  bench.check(clamp, 1);
  ASSERT_TRUE(bench.run(straight(-20)));
  EXPECT_TRUE(bench.bench.planner.blocked());
  EXPECT_EQ(bench.rests_at(), Vector3d::Zero());
  EXPECT_THAT(described(*bench.guard.obstacle()), HasSubstr("meet where the machine stands"));
}

// Red when stock is held against the machine once nobody knows what is left of it, or no longer before.
TEST(GuardedPath, HoldsTheStockAgainstTheMachineUntilSomethingIsCut) {
  const Block stock{Block::Kind::Box, {30, 0, 0}, {5, 50, 50}};
  GuardedBench first, second;
  first.check(stock, 1, SceneBody::Kind::Stock);
  ASSERT_TRUE(first.run(straight(40)));
  EXPECT_TRUE(first.bench.planner.blocked());
  EXPECT_TRUE(first.guard.take_remarks().empty());

  second.check(stock, 1, SceneBody::Kind::Stock);
  std::vector<Move> moves = straight(10, false);
  moves.push_back(straight(40).front());
  ASSERT_TRUE(second.run(moves));
  EXPECT_FALSE(second.bench.planner.blocked());
  EXPECT_THAT(second.guard.take_remarks(), testing::ElementsAre(HasSubstr("the stock is not checked any more")));
}

TEST(GuardedPath, SaysThatAToolWithoutAShapeIsNotChecked) {
  GuardedBench bench;
  bench.check({Block::Kind::Ball, {0, 40, 0}, {1, 1, 1}}, 1);
  bench.guard.set_tool(std::make_shared<const Tool>(Tool{.number = 3}));
  ASSERT_TRUE(bench.run(straight(10)));
  EXPECT_THAT(bench.guard.take_remarks(), testing::ElementsAre(HasSubstr("tool 3 has no Shape")));
}

// Red when a machine that is stepped move by move spins, or stops elsewhere, for the gate.
TEST(GuardedPath, RunsOneMoveAtATime) {
  GuardedBench bench(true);
  bench.check({Block::Kind::Ball, {0, 40, 0}, {1, 1, 1}}, 1);
  ASSERT_TRUE(bench.bench.queue(straight(10).front()));
  ASSERT_TRUE(bench.bench.queue(straight(20).front()));
  bench.bench.planner.command(PathCommand::RunOne);
  ASSERT_TRUE(bench.bench.run());
  EXPECT_NEAR(bench.rests_at()[0], 10, 1e-9);
}

/// Lets each segment through so many cycles after it was asked for.
class SlowGate final : public PathGate {
 public:
  explicit SlowGate(int takes) : takes_(takes) {}
  void ask(std::shared_ptr<const PathSegment> segment) override { asked_.push_back({std::move(segment), now}); }
  Answer answer() override {
    if (asked_.empty() || now < asked_.front().since + takes_) return {};
    passed_x = asked_.front().segment->pose(asked_.front().segment->length()).tip[0];
    asked_.pop_front();
    return {Answer::Kind::Passes, 0};
  }
  void forget() override { asked_.clear(); }
  [[nodiscard]] std::size_t ahead() const noexcept override { return 2; }

  int now = 0;
  double passed_x = 0;

 private:
  struct Asked {
    std::shared_ptr<const PathSegment> segment;
    int since = 0;
  };
  int takes_;
  std::deque<Asked> asked_;
};

// Red when the planner runs on what has not passed, or does not go on once it has.
TEST(GuardedPath, WaitsForACheckThatIsSlow) {
  constexpr int kMoves = 20;
  for (const int takes : {1, 40, 700}) {
    rmac::test::PlannerBench bench(rmac::test::mill());
    SlowGate gate(takes);
    bench.planner.set_gate(&gate);
    for (int i = 0; i < kMoves; ++i) {
      const ToolPose from{{2.0 * i, 0, 0}, rmac::test::kUp}, to{{2.0 * (i + 1), 0, 0}, rmac::test::kUp};
      ASSERT_TRUE(bench.queue({.id = i, .geometry = LineGeometry{from, to}, .feed_mm_s = 50}));
    }
    bench.planner.command(PathCommand::Run);
    int rests = 0;
    while (bench.moves_done() < kMoves && gate.now < 100'000) {
      ++gate.now;
      bench.cycles_with_late_planner(1);
      ASSERT_LE(bench.record.back().position[0], gate.passed_x + 1e-9) << "cycle " << gate.now << ", takes " << takes;
      rests += bench.record.size() > 1 && !bench.record.back().moving && bench.record.end()[-2].moving ? 1 : 0;
    }
    EXPECT_EQ(bench.moves_done(), std::size_t{kMoves}) << "takes " << takes;
    EXPECT_EQ(rests > 1, takes == 700) << rests << " rests on the way, takes " << takes;
    const auto peaks = bench.peaks();
    EXPECT_LE(peaks.velocity, 1.0001);
    EXPECT_LE(peaks.acceleration, 1.001);
    EXPECT_LE(peaks.jerk, 1.01) << "cycle " << peaks.jerk_cycle << ", takes " << takes;
    bench.planner.set_gate(nullptr);
  }
}

}  // namespace
}  // namespace rmac::gateway
