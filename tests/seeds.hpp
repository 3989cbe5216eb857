#pragma once

#include <gtest/gtest.h>

#include "gateway/threads/sanitized.hpp"

namespace rmac::test {

/// Seeds 1 to `count`; under a sanitizer, which makes minutes of each second, the first third of them.
inline auto seeds(unsigned count) {
  return testing::Range(1U, 1U + (kSanitized ? (count + 2) / 3 : count));
}

}  // namespace rmac::test
