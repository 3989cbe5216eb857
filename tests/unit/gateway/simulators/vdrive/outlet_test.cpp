#include "gateway/simulators/vdrive/outlet.hpp"

#include <gtest/gtest.h>

namespace rmac::vdrive {
namespace {

using std::chrono::milliseconds;

std::vector<int> ids(const std::vector<CanFrame>& frames) {
  std::vector<int> result;
  for (const CanFrame& frame : frames) result.push_back(frame.id);
  return result;
}

using Ids = std::vector<int>;

TEST(Outlet, GivesWhatWasSentInOrderOnce) {
  Outlet outlet;
  outlet.send(1, {0xAA, 0xBB});
  outlet.send(2, {});
  const auto frames = outlet.take(Time{0});
  ASSERT_EQ(ids(frames), (Ids{1, 2}));
  EXPECT_EQ(frames[0].size, 2);
  EXPECT_EQ(frames[0].data[1], 0xBB);
  EXPECT_TRUE(outlet.take(Time{0}).empty());
}

TEST(Outlet, SwallowsWhatIsSentWhileItIsMute) {
  Outlet outlet;
  outlet.set_mute(true);
  outlet.send(1, {});
  EXPECT_TRUE(outlet.take(Time{0}).empty());
  outlet.set_mute(false);
  EXPECT_TRUE(outlet.take(Time{0}).empty()) << "lost, not late";
}

TEST(Outlet, HoldsBackWhatIsLateAlsoAfterTheDelayEnds) {
  Outlet outlet;
  outlet.set_delay(milliseconds(10));
  outlet.send(1, {});
  EXPECT_TRUE(outlet.take(milliseconds(0)).empty());
  outlet.set_delay(milliseconds(0));
  outlet.send(2, {});
  EXPECT_TRUE(outlet.take(milliseconds(9)).empty()) << "frames do not overtake each other";
  EXPECT_EQ(ids(outlet.take(milliseconds(10))), (Ids{1, 2}));
}

TEST(Outlet, ForgetsEverythingWithThePower) {
  Outlet outlet;
  outlet.set_delay(milliseconds(10));
  outlet.send(1, {});
  EXPECT_TRUE(outlet.take(milliseconds(0)).empty());
  outlet.send(2, {});
  outlet.clear();
  EXPECT_TRUE(outlet.take(milliseconds(100)).empty());
}

}  // namespace
}  // namespace rmac::vdrive
