#include "gateway/controller/real_time.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <thread>

namespace rmac::gateway {
namespace {

std::string locked_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmLck:")) return line;
  }
  return {};
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
