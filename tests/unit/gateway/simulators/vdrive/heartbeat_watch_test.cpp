#include "gateway/simulators/vdrive/heartbeat_watch.hpp"

#include "unit/gateway/simulators/vdrive/node_bench.hpp"

namespace rmac::vdrive::test {
namespace {

using std::chrono::milliseconds;

constexpr std::int64_t kNode9After50ms = 9 << 16 | 50;

TEST(HeartbeatWatch, BeginsWithTheFirstHeartbeat) {
  HeartbeatWatch watch;
  watch.configure(1, kNode9After50ms);
  EXPECT_EQ(watch.lost(milliseconds(1000)), 0);
  watch.hear(frame(0x709, {5}), milliseconds(1000));
  EXPECT_EQ(watch.lost(milliseconds(1050)), 0);
  EXPECT_EQ(watch.lost(milliseconds(1051)), 1);
  EXPECT_EQ(watch.lost(milliseconds(1052)), 0) << "told once";
  watch.hear(frame(0x709, {5}), milliseconds(1060));
  EXPECT_EQ(watch.lost(milliseconds(1111)), 1) << "and again after it came back";
}

TEST(HeartbeatWatch, HearsTheNodeThatIsWatchedAlone) {
  HeartbeatWatch watch;
  watch.configure(2, kNode9After50ms);
  watch.hear(frame(0x709, {5}), milliseconds(0));
  watch.hear(frame(0x708, {5}), milliseconds(40));
  watch.hear(frame(0x709, {5, 5}), milliseconds(40));  // no heartbeat
  EXPECT_EQ(watch.lost(milliseconds(51)), 1);
}

TEST(HeartbeatWatch, ListensToTwoAndToldOffToNone) {
  HeartbeatWatch watch;
  watch.configure(1, kNode9After50ms);
  watch.configure(2, 10 << 16 | 50);
  watch.hear(frame(0x709, {5}), milliseconds(0));
  watch.hear(frame(0x70A, {5}), milliseconds(0));
  EXPECT_EQ(watch.lost(milliseconds(51)), 2);
  watch.configure(1, 50);        // node 0
  watch.configure(2, 10 << 16);  // no time
  watch.hear(frame(0x700, {5}), milliseconds(60));
  watch.hear(frame(0x70A, {5}), milliseconds(60));
  EXPECT_EQ(watch.lost(milliseconds(1000)), 0);
}

}  // namespace
}  // namespace rmac::vdrive::test
