// What a process does that is told to end. Each runs in a process of its own, because signals are the whole process's.
#include "gateway/rmacd/end_signals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <future>

namespace rmac::gateway {
namespace {

using namespace std::chrono_literals;

/// Ends with 3 if it was told nothing that it should have been told.
[[noreturn]] void end_by(int signal) {
  EndSignals::block();
  std::promise<std::string> told;
  auto name = told.get_future();
  const EndSignals signals([&told](const char* which) { told.set_value(which); }, 1h, [] { std::_Exit(4); });
  ::kill(::getpid(), signal);
  ::kill(::getpid(), signal);
  ::kill(::getpid(), SIGTERM);
  std::fputs(name.get().c_str(), stderr);
  std::_Exit(0);
}

TEST(EndSignalsDeathTest, AreToldOnceByTheirNameAndKillNobody) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  EXPECT_EXIT(end_by(SIGTERM), testing::ExitedWithCode(0), "SIGTERM");
  EXPECT_EXIT(end_by(SIGINT), testing::ExitedWithCode(0), "SIGINT");
  EXPECT_EXIT(end_by(SIGHUP), testing::ExitedWithCode(0), "SIGHUP");
}

TEST(EndSignalsDeathTest, EndAProcessWhoseOtherThreadsHang) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto hang = [] {
    EndSignals::block();
    const EndSignals signals([](const char*) {}, 1ms, [] { std::_Exit(7); });
    ::kill(::getpid(), SIGTERM);
    std::promise<void>().get_future().wait();  // for ever
  };
  EXPECT_EXIT(hang(), testing::ExitedWithCode(7), "");
}

TEST(EndSignalsDeathTest, DoNotCountAPipeThatBreaks) {
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto write_to_nobody = [] {
    EndSignals::block();
    int ends[2];
    if (::pipe(ends) != 0) std::_Exit(1);
    ::close(ends[0]);
    std::_Exit(::write(ends[1], "x", 1) == -1 ? 0 : 1);
  };
  EXPECT_EXIT(write_to_nobody(), testing::ExitedWithCode(0), "");
}

TEST(EndSignals, HaveNoThreadLeftWhenNothingEnds) {
  const EndSignals signals([](const char*) { FAIL(); }, 1h, [] { FAIL(); });
}

}  // namespace
}  // namespace rmac::gateway
