#include "force_on_mill.hpp"

namespace rmac::mill_test {
namespace {

void record(const ForcePass& pass) {
  testing::Test::RecordProperty("worst_force_percent", std::to_string(100 * pass.worst_share));
  testing::Test::RecordProperty("path_error_um", std::to_string(1e3 * pass.path_error_mm));
  testing::Test::RecordProperty("settled_ms", std::to_string(1e3 * pass.settled_s));
}

class FrictionStirPass : public testing::TestWithParam<double> {};

// A sheet that rises by 5 mm a metre and waves by 20 µm every 50 mm.
TEST_P(FrictionStirPass, KeepsItsForceWithinTwoPercentWhileThePathIsFollowed) {
  const ForcePass pass = ForceOnMill().press_and_go(
      200, {.surface_mm = -3, .stiffness_n_mm = GetParam(), .slope = 0.005, .wave_mm = 0.02, .wave_length_mm = 50});
  EXPECT_LE(pass.worst_share, 0.02);
  EXPECT_LT(pass.path_error_mm, 0.05) << "less than a tenth of the following-error bound";
  EXPECT_LE(pass.approach_set_mm_s, 5);
  EXPECT_LT(pass.touch_mm_s, 5.5);
  EXPECT_LT(pass.overshoot_n, 60);
  EXPECT_LT(pass.settled_s, 1.5);
  EXPECT_LE(pass.release_torque_step, 0.01);
  EXPECT_LT(pass.release_jump_mm, 0.005);
  record(pass);
}

INSTANTIATE_TEST_SUITE_P(OnStiffness, FrictionStirPass, testing::Values(200.0, 300.0, 500.0, 700.0, 1000.0),
                         [](const auto& stiffness) { return std::to_string(static_cast<int>(stiffness.param)); });

}  // namespace
}  // namespace rmac::mill_test
