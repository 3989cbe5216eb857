// Absurd values: each gets an error, and changes nothing.
#include <gmock/gmock.h>

#include <random>

#include "gateway/api/methods/method_table.hpp"
#include "unit/gateway/api/setters/setter_bench.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

bool holds_numbers(const ParameterSpec& parameter) {
  switch (parameter.type) {
    case WireType::Number:
    case WireType::Numbers:
    case WireType::Vector:
    case WireType::Frame:
    case WireType::JointTarget:
    case WireType::Nurbs:
    case WireType::NurbsNd:
      return true;
    case WireType::Integer:
      return parameter.enumeration == nullptr && parameter.name != "MoveID";  // the client's own number
    default:
      return false;
  }
}

/// A value of a parameter's type that holds `number`.
json holding(const ParameterSpec& parameter, double number) {
  switch (parameter.type) {
    case WireType::Numbers:
      return json::array({number, 1, 1});
    case WireType::Vector:
      return json::array({0, number, 0});
    case WireType::Frame:
    case WireType::JointTarget:
      return {{"p", {0, 0, number}}, {"q", {1, 0, 0, 0}}};
    case WireType::String:
      return "DMACXYZKinematics";
    case WireType::Boolean:
      return true;
    case WireType::Integer:
      if (parameter.enumeration != nullptr) return parameter.enumeration->values.front().number;
      return number;
    default:
      return number;
  }
}

double sound_number(const ParameterSpec& parameter) {
  return std::isfinite(parameter.range.min) ? parameter.range.min : 0;
}

/// A number that the range does not hold: far out, just out, or nearly zero, of either sign.
double bad_number(const Range& range, std::mt19937& random) {
  for (;;) {
    const double size = std::pow(10, std::uniform_real_distribution<>(-300, 300)(random));
    const double beyond = std::uniform_real_distribution<>(1e-9, 1)(random);
    const std::array<double, 5> candidates{size, -size, range.max + beyond * std::abs(range.max),
                                           range.min - beyond * std::abs(range.min), -1};
    const double chosen = candidates[random() % candidates.size()];
    if (!range.contains(chosen)) return chosen;
  }
}

TEST(BadValues, EveryNumberThatChangesTheMachineHasDeclaredBounds) {
  for (const Method& method : method_table()) {
    if (method.permission != Permission::Authority && method.permission != Permission::Operator) continue;
    for (const ParameterSpec& parameter : method.parameters) {
      if (!holds_numbers(parameter)) continue;
      EXPECT_TRUE(std::isfinite(parameter.range.min) && std::isfinite(parameter.range.max))
          << method.name << ": declare a range for " << parameter.name;
    }
  }
}

TEST(BadValues, EachGetsAnErrorAndChangesNothing) {
  SetterBench bench;
  const Trace before = bench.tip_to(10, 0, 0);
  bench.tip_to(0, 0, 0);
  std::mt19937 random(20261121);
  int asked = 0;
  for (const Method& method : method_table()) {
    const bool changes = method.permission == Permission::Authority || method.permission == Permission::Operator;
    if (!changes || method.effect == Effect::Queues) continue;
    for (const ParameterSpec& bad : method.parameters) {
      if (!holds_numbers(bad)) continue;
      for (int i = 0; i < 40; ++i) {
        json params = json::object();
        for (const ParameterSpec& parameter : method.parameters) {
          const bool spoiled = parameter.name == bad.name;
          params[parameter.name] =
              holding(parameter, spoiled ? bad_number(bad.range, random) : sound_number(parameter));
        }
        const std::string message = bench.refusal(method.name, params.dump());
        EXPECT_THAT(message, HasSubstr("\"" + bad.name + "\""));
        ++asked;
      }
      if (HasFailure()) return;
    }
  }
  EXPECT_GT(asked, 1000);
  bench.apply();
  const Trace after = bench.tip_to(10, 0, 0);
  ASSERT_EQ(after.size(), before.size()) << "the machine moves as it did";
  for (std::size_t i = 0; i < after.size(); ++i) {
    ASSERT_NEAR(after[i].position_set[0], before[i].position_set[0], 1e-9) << "sample " << i;
  }
}

TEST(BadValues, AnOverrideThatIsNeitherZeroNorMotionIsRefused) {
  SetterBench bench;
  EXPECT_THAT(bench.refusal("RMAC_CAM.SetFeedOverride", R"({"Percent": 1e-300})"), HasSubstr("0.01 to 200"));
  bench.call("RMAC_CAM.SetFeedOverride", R"({"Percent": 0})");
  bench.call("RMAC_CAM.SetFeedOverride", R"({"Percent": 100})");
}

TEST(BadValues, LimitsThatExcludeWhereAJointStandsAreRefused) {
  SetterBench bench;
  bench.tip_to(0, 30, 0);
  bench.call("RMAC_Config.SetMechanismJointMaximumLimit", R"({"JntNum": 1, "MaxJntLimit": 20})");
  EXPECT_THAT(bench.refusal("RMAC_Config.Apply"),
              AllOf(HasSubstr("joint 1 \"Y\""), HasSubstr("30.0000"), HasSubstr("-50 to 20")));
  EXPECT_NEAR(bench.tip_to(0, 40, 0).back().position_set[1], 40, 1e-5) << "the old limits are in force";
  bench.tip_to(0, 10, 0);
  bench.apply();
  EXPECT_THAT(bench.tip_refusal(0, 30, 0), HasSubstr("beyond its limit of 20"));
}

}  // namespace
}  // namespace rmac::gateway
