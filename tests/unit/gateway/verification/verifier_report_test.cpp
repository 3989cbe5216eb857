#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "gateway/verification/report.hpp"

namespace rmac::verifier {
namespace {

using testing::HasSubstr;

Report example() {
  const double infinity = std::numeric_limits<double>::infinity();
  ModuleReport good{"kinematics", "Good", "today", {"it loads"}, {"its bus"}, std::nullopt, 0.25};
  ModuleReport bad{"actuator map", "Bad", "", {}, {}, CounterExample{"inverse", "it is 0.1 off", 7, {}}, 1};
  bad.refusal->values = {{"joints", {0.1, -3, infinity}}, {"pose", {std::nan("")}}};
  return {"Machine", "/machine/device.json", 1000, 5, {good, bad}};
}

TEST(VerifierReport, KeepsEveryDigitOnItsWay) {
  const Report back = report_of(nlohmann::json::parse(to_json(example()).dump()));
  EXPECT_EQ(to_json(back), to_json(example()));
  ASSERT_EQ(back.modules.size(), 2U);
  ASSERT_TRUE(back.modules[1].refusal);
  EXPECT_EQ(back.modules[1].refusal->values[0].numbers, (example().modules[1].refusal->values[0].numbers));
  EXPECT_TRUE(std::isnan(back.modules[1].refusal->values[1].numbers[0]));
}

TEST(VerifierReport, RefusesWhereOneModuleIsRefused) {
  Report report = example();
  EXPECT_FALSE(report.passed());
  EXPECT_EQ(report.refusal(), "actuator map Bad: inverse: it is 0.1 off (sample 7; joints 0.1 -3 inf; pose nan)");
  EXPECT_THAT(to_text(report), HasSubstr("Machine is refused"));
  report.modules.pop_back();
  EXPECT_TRUE(report.passed());
  EXPECT_EQ(report.refusal(), "");
  EXPECT_THAT(to_text(report), HasSubstr("Machine may go live"));
}

}  // namespace
}  // namespace rmac::verifier
