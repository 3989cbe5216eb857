#include "servo/setpoint/contact_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "unit/motion/servo/period.hpp"

namespace rmac::servo_test {
namespace {

ForceControl search_control() {
  return {.approach_speed = 8, .contact_force = 10, .max_speed = 20, .max_force = 500, .max_search = 4};
}

/// A joint that presses down; forces here are how much it does.
class SearchForContact : public testing::Test {
 protected:
  void run(int cycles, double pressed) {
    for (int i = 0; i < cycles; ++i) search_.step(-100, -pressed, -8);
  }
  /// Contact and none in turn, of so many cycles each.
  void bounce(int times, int touching, int flying) {
    for (int i = 0; i < times; ++i) {
      run(touching, 50);
      run(flying, 0);
    }
  }
  ContactSearch search_{search_control(), kPeriod};
};

TEST_F(SearchForContact, HoldsUntilAForceIsWanted) {
  search_.step(0, -50, 0);
  EXPECT_EQ(search_.state(), ContactState::Holding);
  run(1, 0);
  EXPECT_EQ(search_.state(), ContactState::Approaching);
  EXPECT_EQ(search_.velocity(), -8);
  search_.step(0, -50, 0);
  EXPECT_EQ(search_.state(), ContactState::Holding);
}

TEST_F(SearchForContact, HasItFromItsForceOnAndLosesItBelowHalf) {
  run(5, 9.9);
  EXPECT_EQ(search_.state(), ContactState::Approaching);
  run(1, 10);
  EXPECT_EQ(search_.state(), ContactState::Touching);
  run(500, 5.1);
  EXPECT_EQ(search_.state(), ContactState::Touching);
  run(1, 4.9);
  EXPECT_EQ(search_.state(), ContactState::Approaching);
}

TEST_F(SearchForContact, PullsWhereItIsToPull) {
  search_.step(100, -50, 0);
  EXPECT_EQ(search_.state(), ContactState::Approaching);
  EXPECT_EQ(search_.velocity(), 8);
  search_.step(100, 12, 0);
  EXPECT_EQ(search_.state(), ContactState::Touching);
}

TEST_F(SearchForContact, CountsItsWayFromWhereContactWasLost) {
  run(250, 0);
  EXPECT_NEAR(search_.searched(), 2, 1e-9);
  run(100, 50);
  run(125, 0);
  EXPECT_NEAR(search_.searched(), 1, 1e-9);
}

TEST_F(SearchForContact, IsSettledOnceItLastsLongerThanABounce) {
  run(10, 50);
  EXPECT_FALSE(search_.settled());
  run(2, 50);
  EXPECT_TRUE(search_.settled());
  run(1, 0);
  EXPECT_FALSE(search_.settled());
  EXPECT_TRUE(search_.bounces());
  run(18, 0);
  EXPECT_TRUE(search_.bounces());
  run(2, 0);
  EXPECT_FALSE(search_.bounces()) << "it has left the part";
}

TEST_F(SearchForContact, DoesNotBounceWhereItNeverTouched) {
  run(1, 0);
  EXPECT_FALSE(search_.bounces());
}

TEST_F(SearchForContact, DrawsBackFromAPartThatItBouncesOffAndComesAgainAtHalfTheSpeed) {
  double speed = 8;
  for (int again = 0; again < 3; ++again) {
    bounce(15, 4, 8);
    EXPECT_EQ(search_.velocity(), -speed) << "not yet";
    bounce(2, 4, 8);
    EXPECT_EQ(search_.state(), ContactState::Approaching);
    EXPECT_EQ(search_.velocity(), 8) << "away";
    run(10, 50);
    EXPECT_EQ(search_.state(), ContactState::Approaching) << "whatever it touches on its way back";
    EXPECT_FALSE(search_.bounces());
    run(50, 0);
    speed /= 2;
    EXPECT_EQ(search_.velocity(), -speed);
  }
  run(20, 50);
  EXPECT_EQ(search_.velocity(), -8) << "contact that lasts ends it";
}

TEST_F(SearchForContact, DrawsBackWhereItIsToLetGo) {
  run(100, 50);
  search_.step(0, -50, 0);
  EXPECT_EQ(search_.velocity(), 0) << "it holds";
  search_.let_go();
  for (int i = 0; i < 349; ++i) {
    search_.step(0, i < 300 ? -5 : -4.9, 0);
    ASSERT_EQ(search_.velocity(), 8) << "as long as it touches, and for a moment more";
    ASSERT_EQ(search_.state(), ContactState::Holding);
  }
  search_.step(0, 0, 0);
  search_.step(0, 0, 0);
  EXPECT_EQ(search_.velocity(), 0);
}

TEST_F(SearchForContact, LeavesItsPartWhereItIsToPullAndNeverGoesIntoIt) {
  bounce(17, 4, 8);
  ASSERT_EQ(search_.velocity(), 8) << "it draws back";
  search_.step(100, -50, 0);
  EXPECT_EQ(search_.velocity(), 8);
  EXPECT_FALSE(search_.bounces());
  run(100, 50);
  search_.step(0, -50, 0);
  search_.let_go();
  search_.step(100, -50, 0);
  EXPECT_EQ(search_.velocity(), 8);
}

TEST_F(SearchForContact, StopsLettingGoWhereItsSensorHangs) {
  run(100, 50);
  search_.step(0, -50, 0);
  search_.let_go();
  int away = 0;
  for (int i = 0; i < 5000; ++i) {
    search_.step(0, -50, 0);
    away += search_.velocity() != 0 ? 1 : 0;
  }
  EXPECT_NEAR(away, 1050, 2);
}

TEST_F(SearchForContact, EndsWithContactHoweverMuchABodyBounces) {
  std::mt19937 random(8);
  for (int i = 0; i < 50; ++i) {
    ContactSearch search(search_control(), kPeriod);
    const double restitution = std::uniform_real_distribution(0.3, 0.99)(random);
    double height = 1, speed = 0;  // mm, mm/s: thrown back, it comes down by what pushes it
    int settled = 0;
    for (int cycle = 0; cycle < 20'000 && settled < 100; ++cycle) {
      const bool down = height <= 0;
      search.step(-100, down ? -60 : 0, speed);
      settled = search.settled() ? settled + 1 : 0;
      const bool flies = search.state() == ContactState::Approaching && !search.bounces();
      if (flies) {
        speed = search.velocity();
      } else if (down) {
        speed = std::abs(speed) < 0.3 ? 0 : restitution * std::abs(speed);
      } else {
        speed -= 1000 * kPeriod;
      }
      height = std::max(0.0, height + speed * kPeriod);
    }
    EXPECT_EQ(settled, 100) << restitution;
  }
}

}  // namespace
}  // namespace rmac::servo_test
