#include "gateway/processes/child_process.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using std::chrono::seconds;
using testing::HasSubstr;

constexpr seconds kLong{60};
const std::atomic<bool> kNever{false};

TEST(Child, IsHeardOnBothStreamsAndGivesItsExitCode) {
  const auto done = run_child({"/bin/sh", "-c", "echo said; echo complained >&2; exit 3"}, kLong, kNever);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->output, "said\n");
  EXPECT_EQ(done->complaint, "complained\n");
  EXPECT_EQ(done->exit_code, 3);
}

TEST(Child, MaySayMoreThanAPipeHolds) {
  const auto done = run_child({"/bin/sh", "-c", "yes | head -c 1000000; yes | head -c 1000000 >&2"}, kLong, kNever);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->output.size(), 1'000'000U);
  EXPECT_EQ(done->complaint.size(), 1'000'000U);
}

TEST(Child, ThatASignalEndsIsToldSo) {
  const auto done = run_child({"/bin/sh", "-c", "kill -SEGV $$"}, kLong, kNever);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->exit_code, -11);
}

TEST(Child, IsKilledWithItsOwnChildrenWhenItTakesTooLong) {
  // The inner one holds the pipe open: were it not killed too, this would last until it ends.
  const auto done = run_child({"/bin/sh", "-c", "sleep 1000 & sleep 1000"}, seconds(0), kNever);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("was killed"));
}

TEST(Child, IsKilledWhenNobodyWaitsForIt) {
  const std::atomic<bool> cancelled{true};
  const auto done = run_child({"/bin/sh", "-c", "sleep 1000"}, kLong, cancelled);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("nobody waits for it"));
}

TEST(Child, ThatIsNotThereIsNamed) {
  const auto done = run_child({"/no/such/program"}, kLong, kNever);
  ASSERT_FALSE(done);
  EXPECT_THAT(done.error().message, HasSubstr("/no/such/program cannot be run"));
}

TEST(Child, InheritsNothingThatIsOpenHere) {
  const auto done = run_child({"/bin/sh", "-c", "ls /proc/self/fd | wc -l"}, kLong, kNever);
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(done->output, "4\n") << "standard input, output and error, and ls's own folder";
}

}  // namespace
}  // namespace rmac::gateway
