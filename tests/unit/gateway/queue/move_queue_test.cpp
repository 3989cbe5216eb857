#include "gateway/queue/move_queue.hpp"

#include <gmock/gmock.h>

#include "unit/motion/planner/planner_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using Kind = QueueChange::Kind;

class MoveQueueTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::vector<double> zero(3, 0.0);
    builder_.restart(zero, {});
    queue_.install(&planner_);
    queue_.begin_here(0);
  }
  bool add(std::int64_t id, double x) {
    const Move move{.id = id, .geometry = PathTargetGeometry{{{x, 0, 0}, {0, 0, 1}}}, .feed_mm_s = 50};
    auto built = build_moves(builder_, {{&move, {}}});
    EXPECT_TRUE(built) << built.error().message;
    return queue_.add(std::move(built->front()));
  }
  void add_tool_change(int number) {
    queue_.add_steps({BeginToolChange{}, MountTool{.number = number}}, step_at(builder_, number));
  }
  [[nodiscard]] std::vector<std::pair<Kind, std::int64_t>> told() {
    std::vector<std::pair<Kind, std::int64_t>> found;
    for (const QueueChange& change : news_.take().queue) found.emplace_back(change.kind, change.move_id);
    return found;
  }

  PlannerModel model_ = test::mill();
  PlanChannel channel_;
  Planner planner_{model_, channel_};
  PathBuilder builder_{model_};
  CycleNews news_;
  MoveQueue queue_{news_};
};

TEST_F(MoveQueueTest, HandsMovesToThePlannerAndTellsWhichHaveMotion) {
  EXPECT_TRUE(add(1, 5));
  EXPECT_FALSE(add(2, 5)) << "the tool is there already";
  EXPECT_TRUE(add(3, 8));
  EXPECT_EQ(planner_.moves_left(), 2U);
  EXPECT_EQ(queue_.planned(), 2U);
  EXPECT_EQ(queue_.left(), 3U) << "a move without motion is done in its turn, and not before";
  EXPECT_THAT(told(), ElementsAre(std::pair(Kind::Added, 1), std::pair(Kind::Still, 2), std::pair(Kind::Added, 3)));
}

TEST_F(MoveQueueTest, CountsAMoveWithoutMotionAsDoneWithThoseBeforeIt) {
  EXPECT_FALSE(add(1, 0));
  EXPECT_EQ(queue_.left(), 0U) << "nothing is before it";
  EXPECT_TRUE(add(2, 5));
  EXPECT_FALSE(add(3, 5));
  EXPECT_EQ(queue_.left(), 2U);
  planner_.clear();
  EXPECT_EQ(queue_.left(), 0U);
}

TEST_F(MoveQueueTest, CountsWhatNeedsNoCurveOfItsOwn) {
  const auto line_to = [&](std::int64_t id, const Vector& end) {
    const ToolPose begin = builder_.end_pose();
    const Move move{
        .id = id, .geometry = LineGeometry{begin, {end, begin.axis}}, .feed_mm_s = 50, .tolerance_mm = 0.01};
    auto built = build_moves(builder_, {{&move, {}}});
    ASSERT_TRUE(built) << built.error().message;
    queue_.add(std::move(built->front()));
  };
  line_to(1, {5, 0, 0});
  line_to(2, {5, 0, 0});
  line_to(3, {5, 0.002, 0});
  line_to(4, {5, 8, 0});
  EXPECT_EQ(queue_.cleaned().without_motion, 1U);
  EXPECT_EQ(queue_.cleaned().merged, 1U);
  EXPECT_EQ(queue_.left(), 4U) << "all of them are told done in their turn";
  queue_.forget();
  Planner next(model_, channel_);
  queue_.install(&next);
  EXPECT_EQ(queue_.cleaned().merged, 1U) << "another mechanism does not make them undone";
  queue_.install(nullptr);
  EXPECT_EQ(queue_.cleaned().merged, 1U);
}

TEST_F(MoveQueueTest, KeepsMovesBehindAToolChangeFromThePlanner) {
  EXPECT_TRUE(add(1, 5));
  add_tool_change(4);
  EXPECT_TRUE(add(2, 8));
  EXPECT_EQ(queue_.planned(), 1U);
  EXPECT_EQ(queue_.waiting(), 2U) << "the change, and the move behind it; a step that moves nothing is none";
  EXPECT_EQ(queue_.left(), 3U);
  EXPECT_THAT(told(), ElementsAre(std::pair(Kind::Added, 1)));
  queue_.step_done();
  queue_.step_done();
  queue_.plan_next_step();
  EXPECT_EQ(queue_.planned(), 2U);
  EXPECT_EQ(queue_.waiting(), 0U);
  EXPECT_THAT(told(), ElementsAre(std::pair(Kind::Added, 2)));
}

TEST_F(MoveQueueTest, IsHeardOfAsItIsQueuedNotAsItIsPlanned) {
  std::vector<std::int64_t> heard;
  queue_.on_queued([&](const Move& move, auto segments) {
    heard.push_back(move.id);
    EXPECT_FALSE(segments.empty());
  });
  add_tool_change(4);
  EXPECT_TRUE(add(1, 5));
  EXPECT_THAT(heard, ElementsAre(1));
}

TEST_F(MoveQueueTest, BeginsAnewWhenItWasEmptied) {
  EXPECT_TRUE(add(1, 5));
  (void)told();
  EXPECT_FALSE(queue_.begins_anew());
  EXPECT_FALSE(queue_.clear(77, 0)) << "no tool change was in it";
  EXPECT_TRUE(queue_.begins_anew());
  EXPECT_EQ(planner_.moves_left(), 0U);
  EXPECT_EQ(queue_.left(), 0U);
  const auto changes = news_.take().queue;
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].kind, Kind::Cleared);
  EXPECT_EQ(changes[0].cycle, 77);
}

TEST_F(MoveQueueTest, SaysThatAToolChangeWasAmongWhatItForgets) {
  add_tool_change(4);
  EXPECT_TRUE(queue_.forget());
  EXPECT_TRUE(queue_.steps().empty());
  EXPECT_FALSE(queue_.forget()) << "once";
}

TEST_F(MoveQueueTest, GivesOutWhatIsNotDoneAsItWasSent) {
  EXPECT_TRUE(add(1, 5));
  add_tool_change(4);
  EXPECT_TRUE(add(2, 8));
  const auto program = queue_.take_program();
  ASSERT_EQ(program.size(), 3U);
  EXPECT_EQ(std::get<Move>(program[0].what).id, 1);
  EXPECT_EQ(program[0].start.tip[0], 0) << "where the move begins, not where it ends";
  EXPECT_EQ(std::get<int>(program[1].what), 4);
  EXPECT_EQ(program[1].counts, 1U);
  EXPECT_EQ(std::get<Move>(program[2].what).id, 2);
  EXPECT_EQ(program[2].start.tip[0], 5);
}

TEST_F(MoveQueueTest, HoldsNothingWithoutAMechanism) {
  EXPECT_TRUE(add(1, 5));
  (void)queue_.forget();
  queue_.install(nullptr);
  EXPECT_TRUE(queue_.begins_anew());
  EXPECT_EQ(queue_.planned(), 0U);
  EXPECT_EQ(queue_.left(), 0U);
}

}  // namespace
}  // namespace rmac::gateway
