#include "canopen/bus_trouble.hpp"

#include <gmock/gmock.h>

#include "unit/fieldbus/canopen/canopen_bench.hpp"

namespace rmac::fieldbus::canopen {
namespace {

using test::CanopenBench;
using testing::HasSubstr;

TEST(BusTrouble, SaysWhatFailedAndWhatToDo) {
  BusTrouble trouble;
  CanHealth health;
  health.link_down = true;
  trouble.note(health, 3);
  EXPECT_EQ(trouble.text("can0"), "its interface is down; bring it up with systemctl restart rmac-can@can0");
  health = {};
  health.bus_off = true;
  trouble.note(health, 3);
  EXPECT_THAT(trouble.text("can0"), HasSubstr("bus-off"));
  trouble.note({}, 3);
  EXPECT_THAT(trouble.text("can0"), HasSubstr("3 frames were not sent"));
}

TEST_F(CanopenBench, SaysHowManyFramesTheQueueDidNotTake) {
  wire_.add(1);
  make({{"node", {1}}});
  start();
  wire_.full = true;
  cycle();
  cycle();
  EXPECT_FALSE(sound_);
  EXPECT_THAT(master_->fault_text(),
              HasSubstr(std::to_string(master_->counters().unsent) + " frames were not sent since the start"));
  EXPECT_GE(master_->counters().unsent, 4U) << "setpoints and SYNC of two cycles";
}

}  // namespace
}  // namespace rmac::fieldbus::canopen
