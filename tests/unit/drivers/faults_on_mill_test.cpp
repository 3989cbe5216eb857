#include "faults_on_mill.hpp"

namespace rmac::mill_test {
namespace {

class FaultsOnMill : public testing::TestWithParam<Injection> {};

TEST_P(FaultsOnMill, AreDetectedWithinTheirBoundAndEndInTheConfiguredStop) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const FaultOutcome outcome = FaultOnMill(seed).run(GetParam());
    ASSERT_GT(outcome.detected_after, 0) << outcome.where << ": not within " << outcome.bound << " cycles";
    EXPECT_EQ(outcome.fault.stop, outcome.wanted) << outcome.where;
    EXPECT_TRUE(outcome.stopped) << outcome.where;
  }
}

INSTANTIATE_TEST_SUITE_P(OfEveryKind, FaultsOnMill, testing::ValuesIn(every_injection()),
                         [](const auto& kind) { return to_string(kind.param); });

}  // namespace
}  // namespace rmac::mill_test
