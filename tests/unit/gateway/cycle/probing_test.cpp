#include "gateway/cycle/probing.hpp"

#include <gmock/gmock.h>

#include "unit/gateway/cycle/cycle_bench.hpp"

namespace rmac::gateway {
namespace {

using testing::HasSubstr;
using Phase = Measurement::Phase;

class Probes : public testing::Test {
 protected:
  void SetUp() override { bench_.status.probe.ready = true; }
  /// From 5 mm the probe looks for a part up to 20 mm.
  void add() {
    ASSERT_TRUE(bench_.entry.prepare());
    const auto added = probing_.add(CycleBench::move_to(7, 5), CycleBench::move_to(7, 20, 10));
    ASSERT_TRUE(added) << added.error().message;
  }
  void touch() {
    ++bench_.status.probe.hits;
    bench_.status.probe.touching = true;
    bench_.publish();
  }
  CycleBench bench_;
  Probing probing_{bench_.cycle};
};

TEST_F(Probes, StopsWhereItTouchesGoesBackAndTheCycleGoesOn) {
  add();
  EXPECT_EQ(bench_.moves_left(), 1U) << "a measurement is one move";
  EXPECT_FALSE(bench_.queue(8, 0)) << "it ends where it finds the part";
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 9; }));
  touch();
  ASSERT_TRUE(bench_.run_until([&] { return probing_.phase() == Phase::Standing; }));
  EXPECT_LT(bench_.x(), 11);
  bench_.step();
  ASSERT_TRUE(probing_.add_retract(CycleBench::move_to(7, 8)));
  bench_.status.probe.touching = false;
  ASSERT_TRUE(bench_.run_until([&] { return probing_.phase() == Phase::None; }));
  EXPECT_NEAR(bench_.x(), 8, 1e-9);
  EXPECT_EQ(bench_.state(), CycleState::Running);
  ASSERT_TRUE(bench_.queue(8, 0));
  ASSERT_TRUE(bench_.run_until([&] { return bench_.moves_left() == 0; }));
  EXPECT_NEAR(bench_.x(), 0, 1e-9);
}

TEST_F(Probes, StopsTheMachineWhenThereIsNoPart) {
  add();
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  EXPECT_NEAR(bench_.x(), 20, 1e-9);
  const auto events = bench_.events();
  ASSERT_TRUE(std::ranges::any_of(events, [](const Event& event) { return event.code == MinorCode::PartNotFound; }));
  EXPECT_EQ(probing_.phase(), Phase::None);
}

TEST_F(Probes, StopsTheMachineAtAHitThatNobodyAskedFor) {
  ASSERT_TRUE(bench_.queue(1, 20));
  ASSERT_TRUE(bench_.start());
  ASSERT_TRUE(bench_.run_until([&] { return bench_.x() > 9; }));
  touch();
  ASSERT_TRUE(bench_.run_until([&] { return bench_.state() == CycleState::Idle; }));
  EXPECT_LT(bench_.x(), 15);
  EXPECT_EQ(bench_.moves_left(), 0U);
}

TEST_F(Probes, GoesBackOnlyFromAHit) {
  ASSERT_TRUE(probing_.add_retract(CycleBench::move_to(7, 8)));
  EXPECT_EQ(bench_.moves_left(), 0U);
}

TEST_F(Probes, MeasuresNothingBehindAToolChange) {
  {
    const GatewayTurn turn(bench_.cycle.lock);
    bench_.cycle.queue.add_steps({MountTool{.number = 4}}, step_at(bench_.cycle.builder(), 4));
  }
  const auto refused = probing_.add({}, CycleBench::move_to(7, 20));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("a tool change, a dwell"));
}

TEST(ProbesInVirtualMode, TouchWhereTheSimulatedOneDoes) {
  CycleBench bench(true);
  Probing probing(bench.cycle);
  ASSERT_TRUE(bench.entry.prepare());
  ASSERT_TRUE(probing.add({}, CycleBench::move_to(7, 20, 10)));
  ASSERT_TRUE(bench.start());
  ASSERT_TRUE(bench.run_until([&] { return bench.x() > 4; }));
  probing.simulate(true);
  ASSERT_TRUE(bench.run_until([&] { return probing.phase() == Phase::Standing; }));
  EXPECT_LT(bench.x(), 6);
}

}  // namespace
}  // namespace rmac::gateway
