#include "gateway/servo/real_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

namespace rmac::gateway {
namespace {

std::string locked_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmLck:")) return line;
  }
  return {};
}

/// Share of this thread's stack that is in memory.
double resident_stack() {
  pthread_attr_t attributes;
  void* begin = nullptr;
  std::size_t size = 0;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0) return -1;
  ::pthread_attr_getstack(&attributes, &begin, &size);
  ::pthread_attr_destroy(&attributes);
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  std::vector<unsigned char> pages(size / page);
  if (::mincore(begin, pages.size() * page, pages.data()) != 0) return -1;
  const auto there = std::count_if(pages.begin(), pages.end(), [](unsigned char bits) { return (bits & 1U) != 0; });
  return static_cast<double>(there) / static_cast<double>(pages.size());
}

TEST(RealTime, HasAllOfTheThreadsStackInMemoryBeforeItsFirstCycle) {
  // Also for somebody who may not lock memory.
  double before = 0, after = 0;
  std::thread([&] {
    before = resident_stack();
    (void)enter_real_time({.priority = 1, .cpu = -1, .lock_memory = true});
    after = resident_stack();
  }).join();
  ::munlockall();
  EXPECT_LT(before, 0.5);
  EXPECT_EQ(after, 1) << "a cycle that goes deeper than any before it would wait for a page";
}

TEST(RealTime, LeavesMemoryUnlockedAndSaysNothingOfItWhenThatIsWished) {
  const std::string before = locked_memory();
  ASSERT_FALSE(before.empty());
  std::vector<std::string> missing;
  // What it does to scheduling ends with the thread.
  std::thread([&] { missing = enter_real_time({.priority = 1, .cpu = -1, .lock_memory = false}); }).join();
  EXPECT_EQ(locked_memory(), before);
  EXPECT_THAT(missing, testing::Not(testing::Contains(testing::HasSubstr("memory"))));
}

}  // namespace
}  // namespace rmac::gateway
