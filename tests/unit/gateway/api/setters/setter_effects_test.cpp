// A setter counts as working when a test shows its effect on motion or I/O, not through its getter: this is that test,
// and it holds for setters to come.
#include <gtest/gtest.h>

#include <algorithm>

#include "gateway/api/methods/method_table.hpp"
#include "unit/gateway/api/setters/setter_bench.hpp"

namespace rmac::gateway {
namespace {

std::vector<SetterEffect> all_effects() {
  std::vector<SetterEffect> all;
  for (const auto* part : {&config_setter_effects(), &device_setter_effects(), &cam_setter_effects()}) {
    all.insert(all.end(), part->begin(), part->end());
  }
  return all;
}

/// "RMAC_CAM.SetFeedrate", "Device.Machine_SetFeedrate".
bool is_setter(const Method& method) {
  const std::string function = method.name.substr(method.name.find('.') + 1);
  return function.starts_with("Set") || function.starts_with("Machine_Set");
}

std::string test_name(const testing::TestParamInfo<SetterEffect>& effect) {
  std::string name = effect.param.setter;
  std::erase_if(name, [](char c) { return std::isalnum(static_cast<unsigned char>(c)) == 0; });
  return name;
}

class Setter : public testing::TestWithParam<SetterEffect> {};

TEST_P(Setter, ActsOnTheMachine) {
  SetterBench bench;
  if (!HasFailure()) GetParam().shows(bench);
}

INSTANTIATE_TEST_SUITE_P(EachOfTheTable, Setter, testing::ValuesIn(all_effects()), test_name);

TEST(Setters, EachHaveAnEffectShownAbove) {
  for (const Method& method : method_table()) {
    const auto effects = all_effects();
    const auto shown = std::ranges::count(effects, method.name, &SetterEffect::setter);
    EXPECT_EQ(shown, is_setter(method) ? 1 : 0) << method.name << ": give it an entry among the effects";
  }
}

}  // namespace
}  // namespace rmac::gateway
