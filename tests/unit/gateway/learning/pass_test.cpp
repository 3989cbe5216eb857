#include "gateway/learning/pass.hpp"

#include <gtest/gtest.h>

namespace rmac::gateway {
namespace {

class PassTest : public testing::Test {
 protected:
  void add(std::int64_t move, double s, double wanted, double measured, bool moving = true) {
    const double set[1] = {wanted}, error[1] = {wanted - measured};
    pass_.add({cycle_++, move, s, moving, set, error});
  }
  Pass pass_{{0}};
  std::int64_t cycle_ = 0;
};

TEST_F(PassTest, LaysMovesBehindEachOtherByTheWayAcrossTheirBorder) {
  for (int i = 0; i < 10; ++i) add(7, 0.95 + i, 0.95 + i, 0);
  for (int i = 0; i < 10; ++i) add(3, 0.45 + i, 10.95 + i, 0);
  pass_.end();
  ASSERT_EQ(pass_.steps().size(), 20U);
  EXPECT_NEAR(pass_.steps()[10].along_mm, 10.95, 1e-9) << "1 mm a cycle, across the border too";
  EXPECT_NEAR(pass_.steps()[19].along_mm, 19.95, 1e-9);
}

TEST_F(PassTest, ADwellAndAHoldAreNoSteps) {
  add(1, 1, 1, 0);
  for (int i = 0; i < 5; ++i) add(9, 0, 1, 0, false);
  for (int i = 0; i < 5; ++i) add(1, 1, 1, 0);
  add(1, 2, 2, 0);
  pass_.end();
  EXPECT_EQ(pass_.steps().size(), 2U);
  EXPECT_FALSE(pass_.went_back());
}

TEST_F(PassTest, ARetraceAndAMoveThatComesAgainAreNoticed) {
  for (const double s : {1.0, 2.0, 3.0, 2.0, 3.0}) add(1, s, s, 0);
  EXPECT_TRUE(pass_.went_back());
  Pass another({0});
  for (const std::int64_t move : {1, 2, 1}) {
    const double set[1] = {1}, error[1] = {0};
    another.add({0, move, 1, true, set, error});
  }
  EXPECT_TRUE(another.went_back());
}

TEST_F(PassTest, TakesWhatIsToldLateForAnErrorOfTheCycleBefore) {
  Pass late({2});
  for (int i = 0; i < 50; ++i) {
    const double set[1] = {0.1 * i}, error[1] = {0.001 * (i - 2)};
    late.add({i, 1, 0.1 * i, true, set, error});
  }
  late.end();
  for (std::size_t cycle = 0; cycle < 47; ++cycle)
    EXPECT_NEAR(late.error(0, cycle), 0.001 * static_cast<double>(cycle), 1e-12);
  EXPECT_EQ(late.error(0, 49), 0) << "nobody has told yet";
  EXPECT_EQ(late.error(0, 4900), 0);
}

TEST_F(PassTest, OnlyAJointThatMovesIsInError) {
  for (int i = 0; i < 10; ++i) add(1, i, 5, 4);
  EXPECT_EQ(pass_.rms(0), 0);
  for (int i = 10; i < 20; ++i) add(1, i, i, i - 0.5);
  pass_.end();
  EXPECT_NEAR(pass_.rms(0), 0.5, 1e-12);
  EXPECT_NEAR(pass_.largest(0), 0.5, 1e-12);
}

TEST_F(PassTest, CountsCyclesThatNobodyToldOf) {
  add(1, 1, 1, 1);
  cycle_ += 3;
  add(1, 2, 2, 2);
  EXPECT_EQ(pass_.missing(), 3);
}

TEST_F(PassTest, TellsWhetherItEndsWhereItBegan) {
  add(1, 1, 1, 1);
  add(1, 2, 2, 2);
  EXPECT_FALSE(pass_.closed());
  add(2, 1, 1.0005, 1);
  EXPECT_TRUE(pass_.closed());
}

}  // namespace
}  // namespace rmac::gateway
