#include "gateway/rmac_config/spindle_editor.hpp"

#include <gmock/gmock.h>

namespace rmac::gateway {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class Spindle : public testing::Test {
 protected:
  Spindle() {
    device_.spindles.resize(2);
    draft_.restart(&device_);
  }
  [[nodiscard]] const sdk::Spindle& second() const { return draft_.device.spindles[1]; }
  sdk::DeviceObject device_;
  Draft draft_;
  SpindleEditor editor_{draft_};
};

TEST_F(Spindle, HasEachValueInItsPlace) {
  ASSERT_TRUE(editor_.set_maximum_rpm(1, 3000));
  ASSERT_TRUE(editor_.set_maximum_torque(1, 7));
  ASSERT_TRUE(editor_.set_control_method(1, ControlMethod::Position));
  ASSERT_TRUE(editor_.set_servo_law(1, {"Law", {}, {}}));
  ASSERT_TRUE(editor_.set_gains(1, std::vector<double>{1, 2}));
  EXPECT_EQ(second().max_speed_rpm, 3000);
  EXPECT_EQ(second().max_torque_nm, 7);
  EXPECT_EQ(second().method, ControlMethod::Position);
  EXPECT_EQ(second().servo_law.name, "Law");
  EXPECT_THAT(second().gains, ElementsAre(1, 2));
  EXPECT_EQ(draft_.device.spindles[0].max_speed_rpm, 0);
  EXPECT_EQ(draft_.extent, Draft::Extent::Configuration);
}

TEST_F(Spindle, WithoutALawHasNoGains) {
  ASSERT_TRUE(editor_.set_servo_law(1, {"Law", {}, {}}));
  ASSERT_TRUE(editor_.set_gains(1, std::vector<double>{1, 2}));
  ASSERT_TRUE(editor_.set_servo_law(1, {}));
  EXPECT_TRUE(second().gains.empty());
}

TEST_F(Spindle, RefusesWhatItCannotBe) {
  EXPECT_THAT(editor_.set_control_method(0, ControlMethod::Force).error().message,
              HasSubstr("nothing asks a spindle for a force"));
  EXPECT_FALSE(editor_.set_maximum_rpm(0, -1));
  EXPECT_FALSE(editor_.set_maximum_torque(0, -1));
  EXPECT_FALSE(editor_.set_gains(0, std::vector<double>{std::numeric_limits<double>::quiet_NaN()}));
  EXPECT_FALSE(editor_.set_maximum_rpm(2, 100));
  EXPECT_EQ(draft_.extent, Draft::Extent::Loops);
}

}  // namespace
}  // namespace rmac::gateway
