#include "gateway/server/lease_keeper.hpp"

#include <gtest/gtest.h>

#include "unit/gateway/api/fakes.hpp"

namespace rmac::gateway {
namespace {

using testing::Return;

constexpr Lease::Holder kClient = 1, kOther = 2;

/// A keeper without a socket: what it announces is listed.
struct Keeper {
  explicit Keeper(LeaseLostAction lost = LeaseLostAction::Stop) {
    options.lease_lost = lost;
    options.now = [this] { return now; };
  }
  void run() {
    machine.now.state = CycleState::Running;
    machine.now.moving = true;
  }
  void rest() {
    machine.now.state = CycleState::Idle;
    machine.now.moving = false;
  }

  fakes::FakeMachine machine;
  Dispatcher dispatcher{machine};
  asio::io_context io;
  MachineAside aside{io, dispatcher, [] {}};
  std::chrono::steady_clock::time_point now{};
  ServerOptions options;
  std::vector<std::string> told;
  LeaseKeeper lease{dispatcher, aside, options,
                    [this](Event::Kind, const std::string& message) { told.push_back(message); }};
};

TEST(LeaseKeeper, AnnouncesWhoTookTheLeaseOnce) {
  Keeper bench;
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  EXPECT_EQ(bench.told, (std::vector<std::string>{"cam-tool took motion authority"}));
  EXPECT_EQ(bench.lease.holder_name(), "cam-tool");
  EXPECT_FALSE(bench.lease.acquire(kOther, "panel"));
}

TEST(LeaseKeeper, LeavesTheMachineAloneWhenWhoGoesHoldsNothing) {
  Keeper bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).Times(0);
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop()).Times(0);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.run();
  bench.lease.lose(kOther, "panel", "disconnected with");
  EXPECT_TRUE(bench.lease.held_by(kClient));
}

TEST(LeaseKeeper, StopsTheCycleOfAMachineThatRestsWithoutMoves) {
  Keeper bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop()).WillOnce(Return(Expected<>{}));
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).Times(0);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.lease.lose(kClient, "cam-tool", "gave back");
  EXPECT_EQ(bench.told.back(), "cam-tool gave back motion authority");
}

TEST(LeaseKeeper, SaysThatStoppingFailedAndKeepsTheError) {
  Keeper bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now())
      .WillOnce(Return(failure(MinorCode::CommTimeout, "the bus is silent")));
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.run();
  bench.lease.lose(kClient, "cam-tool", "disconnected with");
  EXPECT_EQ(bench.told.back(), "cam-tool disconnected with motion authority; stopping failed: the bus is silent");
  EXPECT_EQ(bench.dispatcher.status().minor, static_cast<int>(MinorCode::CommTimeout));
}

TEST(LeaseKeeper, IsOverdueOnlyAfterItsTimeAndNotAfterASignOfLife) {
  Keeper bench;
  bench.options.lease_timeout = std::chrono::seconds(5);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.now += std::chrono::seconds(5);
  EXPECT_FALSE(bench.lease.overdue());
  bench.lease.heard(kOther);
  bench.now += std::chrono::milliseconds(1);
  EXPECT_TRUE(bench.lease.overdue()) << "another's sign of life is none of the holder's";
  bench.lease.heard(kClient);
  EXPECT_FALSE(bench.lease.overdue());
}

TEST(LeaseKeeper, TellsTheNextHolderHowManyMovesWereDroppedOnce) {
  Keeper bench;
  EXPECT_CALL(bench.machine.cam_mock.queue_mock, moves_left()).WillOnce(Return(3));
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.lease.lose(kClient, "cam-tool", "gave back");
  EXPECT_EQ(bench.told.back(), "cam-tool gave back motion authority; 3 queued moves are dropped");
  EXPECT_EQ((*bench.lease.acquire(kOther, "panel"))["dropped_moves"], 3);
  EXPECT_EQ((*bench.lease.acquire(kOther, "panel"))["dropped_moves"], 0);
}

TEST(LeaseKeeper, SwitchesTheDrivesOffAtRestAndKeepsTheLeaseUntilThen) {
  Keeper bench(LeaseLostAction::StopAndPowerOff);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.run();
  bench.lease.lose(kClient, "cam-tool", "disconnected with");
  EXPECT_FALSE(bench.lease.acquire(kOther, "panel"));
  for (const CycleState state : {CycleState::Running, CycleState::Stopping}) {
    bench.machine.now.state = state;
    bench.machine.now.moving = false;
    bench.lease.power_off_at_rest();
    EXPECT_TRUE(bench.machine.device_fake.device) << "not while it is " << to_string(state);
  }
  bench.rest();
  bench.machine.now.moving = true;
  bench.lease.power_off_at_rest();
  EXPECT_TRUE(bench.machine.device_fake.device) << "not while it moves";
  bench.rest();
  bench.lease.power_off_at_rest();
  EXPECT_FALSE(bench.machine.device_fake.device);
  EXPECT_EQ(bench.told.back(), "the drives are switched off; motion authority is free");
  EXPECT_TRUE(bench.lease.acquire(kOther, "panel"));
}

TEST(LeaseKeeper, LeavesTheDrivesOfARestingMachineOn) {
  Keeper bench(LeaseLostAction::StopAndPowerOff);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.lease.lose(kClient, "cam-tool", "gave back");
  bench.lease.power_off_at_rest();
  EXPECT_TRUE(bench.machine.device_fake.device);
}

TEST(LeaseKeeper, GivesTheLeaseToNobodyAfterTheEndEvenWhenTheDrivesAreOff) {
  Keeper bench(LeaseLostAction::StopAndPowerOff);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.run();
  bench.lease.retire();
  bench.rest();
  bench.lease.power_off_at_rest();
  EXPECT_FALSE(bench.machine.device_fake.device);
  EXPECT_FALSE(bench.lease.acquire(kClient, "cam-tool"));
}

TEST(LeaseKeeper, DropsALeaseWithoutAStop) {
  Keeper bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).Times(0);
  EXPECT_TRUE(bench.lease.acquire(kClient, "cam-tool"));
  bench.run();
  bench.lease.drop(kClient);
  bench.lease.lose(kClient, "cam-tool", "disconnected with");
  EXPECT_FALSE(bench.lease.held_by(kClient));
}

}  // namespace
}  // namespace rmac::gateway
