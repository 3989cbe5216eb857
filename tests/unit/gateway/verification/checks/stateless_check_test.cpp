// What a port keeps between its calls shows in its answers.
#include "gateway/verification/checks/stateless_check.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "gateway/verification/checks/port_calls.hpp"
#include "unit/planar_arm.hpp"

namespace rmac::verifier {
namespace {

using testing::HasSubstr;

KinematicsCase arm_case() {
  KinematicsCase given;
  given.ranges = {{-170, 170}, {-150, 150}, {-100, 0}};
  return given;
}

/// A call that answers its number, and what `more` adds to it.
PortCall call_of(const char* function, double number, std::function<double()> more) {
  return {function, {}, 1, [number, more](std::span<double> answer) { answer[0] = number + more(); }};
}

StatelessCase case_of(const std::function<double()>& first, const std::function<double()>& second) {
  StatelessCase given;
  for (int i = 0; i < 100; ++i) {
    given.calls.push_back(call_of("first", i, first));
    given.calls.push_back(call_of("second", i, second));
  }
  given.most_cpu_s = 2;
  return given;
}

TEST(StatelessCheck, TakesAnArmThatKeepsNothing) {
  const test::PlanarArm arm;
  StatelessCase given;
  given.calls = calls_of(arm, arm_case());
  given.most_cpu_s = 1;
  const auto made = check_stateless(given);
  ASSERT_TRUE(made) << to_string(made.error());
  EXPECT_GE(*made, 1000);
}

TEST(StatelessCheck, TellsWhichFunctionAnswersOtherwiseAfterManyCalls) {
  constexpr int kMany = 15'000;
  int calls = 0;
  const auto tires = [&] { return ++calls > kMany ? 1.0 : 0.0; };
  const auto found = check_stateless(case_of([] { return 0.0; }, tires));
  ASSERT_FALSE(found);
  EXPECT_THAT(to_string(found.error()), HasSubstr("second answers otherwise"));
}

TEST(StatelessCheck, FindsWhatOneFunctionLeavesForTheOther) {
  double left = 0;
  const auto leaves = [&] { return left = 1, 0.0; };
  const auto takes = [&] { return left; };
  const StatelessCase given = case_of(takes, leaves);
  const auto found = check_stateless(given);
  ASSERT_FALSE(found);
  EXPECT_THAT(to_string(found.error()), HasSubstr("first answers otherwise"));
}

TEST(StatelessCheck, FindsWhatTwoThreadsShare) {
  std::atomic<int> inside{0};
  const auto shares = [&] {
    const int others = inside.fetch_add(1);
    std::this_thread::yield();  // the other one comes in on a busy computer, too
    inside.fetch_sub(1);
    return static_cast<double>(others);
  };
  const auto found = check_stateless(case_of(shares, shares));
  ASSERT_FALSE(found);
  EXPECT_THAT(to_string(found.error()), HasSubstr("another thread"));
}

}  // namespace
}  // namespace rmac::verifier
