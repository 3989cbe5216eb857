#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "unit/gateway/rmac/fake_appliance.hpp"

namespace rmac::cli {

/// Calls the client as a person does, with an appliance that the test scripts.
class CommandBench : public testing::Test {
 protected:
  struct Outcome {
    int exit_code = 0;
    std::string out, err;
  };

  /// The words behind `rmac`.
  Outcome run(const std::vector<std::string>& words) { return run_at(appliance_.endpoint().socket, words); }
  /// The same with an appliance at another place.
  static Outcome run_at(const std::string& socket, const std::vector<std::string>& words);

  FakeAppliance appliance_;
};

/// A machine that moves when asked to: at rest again when asked the second time.
void moves_once(FakeAppliance& appliance);

}  // namespace rmac::cli
