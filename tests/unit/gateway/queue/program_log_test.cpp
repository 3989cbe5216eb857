#include "gateway/queue/program_log.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

ProgramStep step(std::int64_t id, std::size_t counts = 1) {
  Move move;
  move.id = id;
  return {.what = move, .start = {}, .start_joints = {}, .counts = counts};
}

std::vector<std::int64_t> ids(const std::deque<ProgramStep>& steps) {
  std::vector<std::int64_t> found;
  for (const ProgramStep& each : steps) found.push_back(std::get<Move>(each.what).id);
  return found;
}

TEST(ProgramLog, ForgetsWhatIsDoneFromTheFront) {
  ProgramLog log;
  for (int id = 1; id <= 4; ++id) log.add(step(id), static_cast<std::size_t>(id));
  log.keep(2);
  EXPECT_THAT(ids(log.take()), testing::ElementsAre(3, 4));
}

TEST(ProgramLog, KeepsAStepOfSeveralMovesUntilItsLastOneIsDone) {
  ProgramLog log;
  log.add(step(1, 3), 3);
  log.add(step(2), 4);
  log.keep(2);
  EXPECT_THAT(ids(log.take()), testing::ElementsAre(1, 2)) << "one of its three moves is still to do";
  log.add(step(1, 3), 3);
  log.add(step(2), 4);
  log.keep(1);
  EXPECT_THAT(ids(log.take()), testing::ElementsAre(2));
}

TEST(ProgramLog, IsEmptyOnceTaken) {
  ProgramLog log;
  log.add(step(1), 1);
  EXPECT_EQ(log.take().size(), 1U);
  EXPECT_TRUE(log.take().empty());
  log.add(step(2), 1);
  EXPECT_THAT(ids(log.take()), testing::ElementsAre(2)) << "counts of what was taken are gone too";
}

}  // namespace
}  // namespace rmac::gateway
