#include "unit/motion/planner/program_fuzz.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

namespace rmac {
namespace {

using test::Action;
using test::FuzzProgram;

/// Whole programs of lines, arcs and NURBS with mixed feeds, tolerances, overrides and holds. RMAC_FUZZ_SEEDS and
/// RMAC_FUZZ_FIRST in the environment look for more than a test run has time for.
TEST(FuzzedProgram, KeepsEveryLimitAndEndsWhereItShould) {
  const auto number = [](const char* name, unsigned otherwise) {
    const char* const text = std::getenv(name);
    return text != nullptr ? static_cast<unsigned>(std::strtoul(text, nullptr, 10)) : otherwise;
  };
  const unsigned first = number("RMAC_FUZZ_FIRST", 1), count = number("RMAC_FUZZ_SEEDS", 8);
  for (unsigned seed = first; seed < first + count; ++seed) {
    const FuzzProgram program = test::random_program(seed);
    if (test::fault_of(program).empty()) continue;
    const FuzzProgram least = test::shrunk(program, [](const FuzzProgram& p) { return !test::fault_of(p).empty(); });
    ADD_FAILURE() << "seed " << seed << ": " << test::fault_of(least) << "\n" << test::as_code(least);
  }
}

TEST(FuzzedProgram, IsShrunkToWhatMakesItFail) {
  FuzzProgram program = test::random_program(5);
  program.actions.resize(4);
  program.actions[2] = {Action::Kind::Override, 400, 150, 0, 0, 1, {}};
  const auto fails = [](const FuzzProgram& p) {
    return std::any_of(p.actions.begin(), p.actions.end(),
                       [](const Action& a) { return a.kind == Action::Kind::Override && a.percent == 150; });
  };
  const FuzzProgram least = test::shrunk(program, fails);
  ASSERT_EQ(least.actions.size(), 1U);
  EXPECT_EQ(least.actions[0].after_cycles, 0);
  EXPECT_NE(test::as_code(least).find("Action::Kind::Override, 0, 150"), std::string::npos) << test::as_code(least);
}

}  // namespace
}  // namespace rmac
