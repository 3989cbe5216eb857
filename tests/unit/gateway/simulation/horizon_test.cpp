// How far ahead motion is planned, as the samples and the topic `state` of a machine tell it.
#include <gtest/gtest.h>

#include "gateway/simulation/simulation.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

class HorizonOfAMachine : public testing::Test {
 protected:
  void SetUp() override {
    auto opened = Simulation::open({.device_tree = fs::path(RMAC_BINARY_DIR) / "drivers",
                                    .searcher = fs::path(RMAC_BINARY_DIR) / "bin/rmac-search"},
                                   "BenchXYZ");
    ASSERT_TRUE(opened) << opened.error().message;
    simulation_ = std::move(*opened);
    simulation_->controller().on_sample([this](const CycleSample& sample) { last_ = sample; });
    call("RMAC_CAM.SetFeedrate", {{"Feedrate", 600}});
    call("RMAC_CAM.SetPathTolerance", {{"Tolerance", 0.01}});
  }
  Json call(const std::string& method, Json params = Json::object()) {
    const Answer answer = simulation_->call(method, std::move(params));
    EXPECT_TRUE(answer) << method << ": " << answer.error().message;
    return answer.value_or(Json());
  }
  void start() { call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}}); }
  void queue_lines(int count) {
    const auto pose = [](double at) { return Json{{"p", {at, at * at / 80, 0}}, {"axis", {0, 0, 1}}}; };
    for (int i = 0; i < count; ++i, x_ += 0.2) {
      call("RMAC_CAM.MoveAlongLine", {{"MoveID", ++id_}, {"StartPoint", pose(x_)}, {"EndPoint", pose(x_ + 0.2)}});
    }
  }
  void queue_dwell(double time_s) { call("RMAC_CAM.Dwell", {{"MoveID", ++id_}, {"Time", time_s}}); }
  /// A cycle, and the word of `state` after it.
  std::string cycle() {
    simulation_->cycle();
    const Json state = call("RMAC_CAM.GetState");
    EXPECT_EQ(state["cycle"], last_.cycle);
    EXPECT_EQ(state["horizon_s"], last_.horizon.s);
    EXPECT_EQ(state["horizon_limit"], to_string(last_.horizon.limit));
    EXPECT_TRUE(!last_.moving || last_.horizon.s > 0) << "in cycle " << last_.cycle;
    return state["horizon_limit"];
  }
  void run_for(int cycles) {
    while (cycles-- > 0) cycle();
  }

  std::unique_ptr<Simulation> simulation_;
  CycleSample last_;

 private:
  int id_ = 0;
  double x_ = 0;
};

// Red when a dwell behind the lines counts as the end of the queue, or when the word stays once it is over.
TEST_F(HorizonOfAMachine, EndsAtADwellAndThenWithTheQueue) {
  queue_lines(20);
  queue_dwell(0.3);
  queue_lines(20);
  EXPECT_EQ(cycle(), "stop") << "no cycle is started";
  start();
  int before = 0, behind = 0;
  while (call("RMAC_CAM.GetState")["moves_in_buffer"] > 0) {
    const std::string word = cycle();
    const std::string waits_for = call("RMAC_CAM.GetState")["waits_for"];
    if (waits_for == "dwell") {
      EXPECT_EQ(word, "rest") << "in cycle " << last_.cycle;
    }
    if (last_.move_id < 20 && word == "rest") ++before;
    if (last_.move_id > 21 && word == "queue") ++behind;
    ASSERT_LT(last_.cycle, 20'000);
  }
  EXPECT_GT(before, 50);
  EXPECT_GT(behind, 50);
  EXPECT_EQ(cycle(), "queue");
}

TEST_F(HorizonOfAMachine, EndsWithAHoldAndIsLongAgainWhenItIsOver) {
  queue_lines(150);
  start();
  run_for(200);
  ASSERT_TRUE(last_.moving);
  EXPECT_EQ(cycle(), "enough");
  call("RMAC_CAM.FeedHold");
  run_for(1);
  do {
    ASSERT_EQ(cycle(), "stop");
  } while (last_.moving);
  ASSERT_EQ(last_.state, CycleState::Holding);
  call("RMAC_CAM.FeedResume");
  run_for(5);
  EXPECT_TRUE(last_.moving);
  EXPECT_EQ(cycle(), "enough");
  EXPECT_GE(last_.horizon.s, kPromisedHorizon_s);
}

/// Lines that take 20 ms at their feed, and less than 100 ms from rest to rest, one every 200 ms.
TEST_F(HorizonOfAMachine, EndsWithTheQueueOfAClientThatIsTooSlow) {
  start();
  int too_short = 0;
  for (int i = 0; i < 2000; ++i) {
    if (i % 200 == 0) queue_lines(1);
    const std::string word = cycle();
    if (!last_.moving || last_.horizon.s >= kPromisedHorizon_s) continue;
    ++too_short;
    ASSERT_EQ(word, "queue") << "in cycle " << last_.cycle;
  }
  EXPECT_GT(too_short, 400);
}

}  // namespace
}  // namespace rmac::gateway
