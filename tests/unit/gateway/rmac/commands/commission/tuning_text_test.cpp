#include "gateway/rmac/commands/commission/tuning_text.hpp"

#include <gtest/gtest.h>

namespace rmac::cli {
namespace {

using nlohmann::json;

const json kNoFilters{{"Resonances", json::array()}, {"LowPass", 0}};
const json kNotch{{"Resonances", {{{"Frequency", 274}, {"Damping", 0.02}, {"Width", 0.3}}}}, {"LowPass", 0}};
const json kLowPass{{"Resonances", json::array()}, {"LowPass", 180}};

TEST(TuningText, KnowsFiltersThatNoSweepLookedAt) {
  for (const json& filters : {kNotch, kLowPass}) {
    EXPECT_TRUE(loses_filters({{"misfit", nullptr}, {"filters_in_force", filters}})) << filters;
    EXPECT_FALSE(loses_filters({{"misfit", 0.1}, {"filters_in_force", filters}})) << filters;
  }
  EXPECT_FALSE(loses_filters({{"misfit", nullptr}, {"filters_in_force", kNoFilters}}));
  EXPECT_FALSE(loses_filters({{"misfit", nullptr}, {"filters_in_force", nullptr}})) << "a law without feedback";
}

}  // namespace
}  // namespace rmac::cli
