#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <string>
#include <vector>

// Where a program's numbers end: the last that is taken and the first that is refused, on each side.

namespace rmac::legacy {

struct Bound {
  std::string lines;  ///< {} is the number
  std::string refusal;
  std::vector<std::string> taken, refused;
};

/// `refusal_of_lines` says "taken", or why lines are refused.
template <typename RefusalOfLines>
void expect_bounds(const std::vector<Bound>& bounds, const RefusalOfLines& refusal_of_lines) {
  for (const Bound& bound : bounds) {
    for (const auto& number : bound.taken) {
      const auto lines = fmt::format(fmt::runtime(bound.lines), number);
      EXPECT_EQ(refusal_of_lines(lines), "taken") << lines;
    }
    for (const auto& number : bound.refused) {
      const auto lines = fmt::format(fmt::runtime(bound.lines), number);
      EXPECT_THAT(refusal_of_lines(lines), testing::HasSubstr(bound.refusal)) << lines;
    }
  }
}

}  // namespace rmac::legacy
