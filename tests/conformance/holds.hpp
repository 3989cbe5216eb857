#pragma once

#include <gtest/gtest.h>

#include "gateway/verification/checks/check.hpp"

namespace rmac::conformance {

/// What the verifier found, for EXPECT_TRUE: its counter-example is the message.
inline testing::AssertionResult holds(const verifier::Checked& checked) {
  return checked ? testing::AssertionSuccess() : testing::AssertionFailure() << to_string(checked.error());
}

}  // namespace rmac::conformance
