#include "gateway/rmac_cam/settings/tool_place.hpp"

#include "unit/gateway/rmac_cam/standing_mill.hpp"

namespace rmac::gateway {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;

class Place : public StandingMill {
 protected:
  void SetUp() override {
    StandingMill::SetUp();
    stand_at({10, 20, 30});
    // The part lies at (1, 2, 3), a quarter turned about Z; the tip is 5 below the tool interface.
    const double half = std::sqrt(0.5);
    supervisor_.set_frames({{{1, 2, 3}, {half, 0, 0, half}}, {{0, 0, -5}, {1, 0, 0, 0}}});
  }
  ToolPlace place_{supervisor_, link_};
};

auto near(double x, double y, double z) {
  return ElementsAre(DoubleNear(x, 1e-12), DoubleNear(y, 1e-12), DoubleNear(z, 1e-12));
}

TEST_F(Place, IsOfTheTipInTheMachine) {
  EXPECT_THAT(place_.in_machine().tip, near(10, 20, 25));
}

TEST_F(Place, IsOfTheTipInThePart) {
  EXPECT_THAT(place_.in_part().tip, near(18, -9, 22));
  EXPECT_THAT(place_.in_part().axis, near(0, 0, 1));
}

TEST_F(Place, IsToldOfOtherJointsToo) {
  EXPECT_THAT(place_.at(std::vector<double>{1, 2, 8}).tip, near(0, 0, 0));
}

TEST_F(Place, GoesByFramesThatWereSetJustNow) {
  supervisor_.set_frames({});
  EXPECT_THAT(place_.in_part().tip, near(10, 20, 30));
}

}  // namespace
}  // namespace rmac::gateway
