#include "gateway/rmac/program/unfinished_moves.hpp"

#include <gtest/gtest.h>

namespace rmac::cli {
namespace {

Request move(std::int64_t id, int line = 1) {
  Request request;
  request.line = line;
  request.timing = Timing::Move;
  request.move_id = id;
  return request;
}

Request tool_change(int line = 1) {
  Request request = move(0, line);
  request.tool_change = true;
  return request;
}

TEST(UnfinishedMoves, MeasureTheTimeFromTheFirstStartToTheLastEnd) {
  UnfinishedMoves moves;
  moves.sent(move(1));
  moves.sent(move(2));
  moves.started(10);
  moves.done(1, 11);
  moves.started(11);
  moves.done(2, 14);
  EXPECT_TRUE(moves.empty());
  EXPECT_EQ(moves.moves_done(), 2U);
  EXPECT_DOUBLE_EQ(moves.cycle_time_s(), 4);
  EXPECT_DOUBLE_EQ(moves.last_done_s(), 14);
}

TEST(UnfinishedMoves, PassOverMovesThatAreNotTheirs) {
  UnfinishedMoves moves;
  moves.started(1);
  moves.done(1, 2);
  EXPECT_EQ(moves.moves_done(), 0U);
  moves.sent(move(1));
  moves.sent(move(2));
  moves.done(2, 3);
  EXPECT_EQ(moves.size(), 2U) << "the first is not done";
  moves.started(5);
  moves.done(1, 7);
  EXPECT_DOUBLE_EQ(moves.cycle_time_s(), 2) << "what started before the first was sent does not count";
}

TEST(UnfinishedMoves, AToolChangeIsOverWhenAToolWasChangedAndNotWhenAMoveIsDone) {
  UnfinishedMoves moves;
  moves.sent(tool_change());
  moves.sent(move(0));
  moves.done(0, 1);
  EXPECT_EQ(moves.size(), 2U) << "a move of id 0 is another";
  moves.tool_changed();
  EXPECT_EQ(moves.tools_changed(), 1U);
  moves.tool_changed();
  EXPECT_EQ(moves.tools_changed(), 1U) << "the next is a move";
  moves.done(0, 2);
  EXPECT_TRUE(moves.empty());
  EXPECT_EQ(moves.moves_done(), 1U);
}

TEST(UnfinishedMoves, NameTheLineOfTheFirst) {
  UnfinishedMoves moves;
  EXPECT_FALSE(moves.line());
  moves.sent(move(1, 12));
  moves.sent(move(2, 15));
  EXPECT_EQ(moves.line(), 12);
  moves.done(1, 1);
  EXPECT_EQ(moves.line(), 15);
}

TEST(UnfinishedMoves, KeepTheLastOnesThatAreToDo) {
  UnfinishedMoves moves;
  for (int id = 1; id <= 4; ++id) moves.sent(move(id, id));
  moves.leave(2);
  EXPECT_EQ(moves.moves_done(), 2U);
  EXPECT_EQ(moves.line(), 3);
  moves.leave(9);
  EXPECT_EQ(moves.size(), 2U);
}

}  // namespace
}  // namespace rmac::cli
