#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rmac::test {

/// What a parameter takes, as docs/simulated-bus.md tells.
struct NumberRange {
  const char* name;
  double least, most;
};

/// Both ends are taken, and nothing beyond them, as `takes` tells of a value.
template <typename Takes>
void expect_range(const NumberRange& range, const Takes& takes) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(takes(range.least)) << range.name;
  EXPECT_TRUE(takes(range.most)) << range.name;
  EXPECT_FALSE(takes(std::nextafter(range.least, -kFar))) << range.name;
  EXPECT_FALSE(takes(std::nextafter(range.most, kFar))) << range.name;
  EXPECT_FALSE(takes(std::numeric_limits<double>::quiet_NaN())) << range.name;
}

}  // namespace rmac::test
