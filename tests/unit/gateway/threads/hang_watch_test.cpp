#include "gateway/threads/hang_watch.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "gateway/threads/cpu_progress.hpp"

namespace rmac::gateway {
namespace {

TEST(HangWatch, TellsWhatItFindsOnce) {
  std::atomic<int> looks{0}, told{0};
  std::promise<std::string> found;
  {
    const HangWatch watch(
        [&]() -> std::optional<std::string> { return ++looks < 3 ? std::nullopt : std::optional("this hangs"); },
        [&](const std::string& what) {
          ++told;
          found.set_value(what);
        });
    EXPECT_EQ(found.get_future().get(), "this hangs");
  }
  EXPECT_EQ(looks, 3);
  EXPECT_EQ(told, 1);
}

TEST(HangWatch, EndsAtOnceWhereNothingHangs) {
  std::promise<void> looked;
  bool first = true;
  const HangWatch watch(
      [&]() -> std::optional<std::string> {
        if (std::exchange(first, false)) looked.set_value();
        return std::nullopt;
      },
      [](const std::string&) { ADD_FAILURE(); });
  looked.get_future().wait();
}

/// Computes for at least so much CPU time.
void compute(std::chrono::nanoseconds much) {
  const auto begin = cpu_time(CLOCK_THREAD_CPUTIME_ID);
  while (cpu_time(CLOCK_THREAD_CPUTIME_ID) - begin <= much) {
  }
}

TEST(CpuProgress, IsStuckWhoComputesWithoutProgress) {
  constexpr std::chrono::milliseconds kPatience{20};
  CpuProgress progress(kPatience);
  compute(kPatience);
  EXPECT_TRUE(progress.stuck());
  progress.made();
  EXPECT_FALSE(progress.stuck());
  compute(kPatience);
  EXPECT_TRUE(progress.stuck());
}

TEST(CpuProgress, IsNotStuckWhoWaits) {
  CpuProgress progress(std::chrono::milliseconds(20));
  std::async(std::launch::async, [] { compute(std::chrono::milliseconds(60)); }).get();
  EXPECT_FALSE(progress.stuck()) << "another thread computed";
}

}  // namespace
}  // namespace rmac::gateway
