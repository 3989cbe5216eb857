#include "gateway/simulators/vdrive/axis/home_search.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

/// By method 35, home is where it stands; by method 33, at the index pulse towards negative positions.
AxisParameters parameters(int method, bool asks) {
  AxisParameters made{};
  made.fast = 1000;
  made.slow = 100;
  made.switches.negative_limit = -1e9;
  made.switches.positive_limit = 1e9;
  made.homing_method = method;
  made.controlword = asks ? 0x1F : 0x0F;
  return made;
}

TEST(HomeSearch, BeginsOnTheRiseOfBitFourOnly) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  HomeSearch search;
  search.step(parameters(33, false), shaft, true);
  EXPECT_EQ(search.state(), Homing::State::Idle);
  EXPECT_EQ(search.step(parameters(33, true), shaft, true), -100) << "slowly, towards the pulse";
  EXPECT_EQ(search.state(), Homing::State::Running);
  search.step(parameters(33, false), shaft, true);
  EXPECT_EQ(search.state(), Homing::State::Idle) << "the master let go";
  EXPECT_EQ(search.step(parameters(33, true), shaft, true), -100);
}

TEST(HomeSearch, FindsHomeWhereItStandsOnce) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  HomeSearch search;
  int found = 0;
  for (int step = 0; step < 5; ++step) {
    search.step(parameters(35, true), shaft, true);
    found += search.found() ? 1 : 0;
  }
  EXPECT_EQ(found, 1);
  EXPECT_EQ(search.state(), Homing::State::Attained);
}

TEST(HomeSearch, SeesThePulseThatTheShaftPassed) {
  Shaft shaft{fieldbus::AxisPlantParameters()};
  HomeSearch search;
  AxisParameters wanted = parameters(33, true);
  wanted.switches.index = -100;
  search.start_from(shaft, wanted.switches.index);
  search.step(wanted, shaft, true);
  EXPECT_FALSE(search.found()) << "no pulse yet";
  while (shaft.angle() > -200) shaft.advance(-0.1, false, 1e-4);
  search.step(wanted, shaft, false);
  EXPECT_TRUE(search.found());
}

TEST(HomeSearch, EndsWithAChangeOfMode) {
  const Shaft shaft{fieldbus::AxisPlantParameters()};
  HomeSearch search;
  search.step(parameters(33, true), shaft, true);
  search.reset();
  EXPECT_EQ(search.state(), Homing::State::Idle);
  search.step(parameters(33, true), shaft, true);
  EXPECT_EQ(search.state(), Homing::State::Running) << "bit 4 counts as risen again";
}

}  // namespace
}  // namespace rmac::vdrive
