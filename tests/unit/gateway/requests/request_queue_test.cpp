#include "gateway/requests/request_queue.hpp"

#include <gtest/gtest.h>

#include "unit/gateway/api/session.hpp"

namespace rmac::gateway {
namespace {

using nlohmann::json;
using testing::_;
using testing::Return;

/// A client without a socket: the lines that it is sent are listed.
struct ListedClient : Requester {
  SessionPort& session() override { return session_fake; }
  std::uint64_t id() const noexcept override { return 3; }
  void send(std::string line) override { answers.push_back(json::parse(line)); }
  bool stays() const noexcept override { return here; }
  void has_stopped(const Request& stop, std::uint64_t position) override {
    stops.emplace_back(stop.method->name, position);
  }
  void pump() override { ++pumped; }
  std::shared_ptr<void> hold() override { return held; }

  fakes::FakeSession session_fake;
  bool here = true;
  std::vector<json> answers;
  std::vector<std::pair<std::string, std::uint64_t>> stops;
  int pumped = 0;
  std::shared_ptr<int> held = std::make_shared<int>();
};

struct QueueBench {
  explicit QueueBench(std::chrono::milliseconds wait = std::chrono::hours(1))
      : queue(client, dispatcher, aside, wait) {}

  void take(int id, const std::string& method, const std::string& params = "[]", std::uint64_t position = 0) {
    queue.take(
        R"({"jsonrpc":"2.0","id":)" + std::to_string(id) + R"(,"method":")" + method + R"(","params":)" + params + "}",
        position);
  }
  void take_move(int id, std::uint64_t position = 0) {
    take(id, "RMAC_CAM.MoveToPathTarget", R"({"MoveID":1,"TargetFrame":{"p":[0,0,0],"axis":[0,0,1]}})", position);
  }
  /// Runs the gateway's thread until the client is to be pumped, or what was away is back.
  void run_until_back() {
    io.restart();  // it stopped when the last work was done
    const auto working = asio::make_work_guard(io);
    for (const int before = client.pumped; client.pumped == before;) io.run_one();
  }
  std::vector<int> answered() const {
    std::vector<int> ids;
    for (const json& answer : client.answers) ids.push_back(answer["id"].get<int>());
    return ids;
  }

  fakes::FakeMachine machine;
  Dispatcher dispatcher{machine};
  asio::io_context io;
  ListedClient client;
  MachineAside aside{io, dispatcher, [this] { client.pump(); }};
  RequestQueue queue;
};

using Progress = RequestQueue::Progress;
using Ids = std::vector<int>;

TEST(RequestQueue, AnswersInOrder) {
  QueueBench bench;
  bench.take(1, "RMAC_CAM.Ok");
  bench.take(2, "no such method");
  bench.take(3, "RMAC_CAM.Ok");
  EXPECT_TRUE(bench.client.answers.empty()) << "in their turn";
  EXPECT_GT(bench.queue.bytes(), 0U);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.answered(), (Ids{1, 2, 3}));
  EXPECT_EQ(bench.queue.bytes(), 0U);
  EXPECT_TRUE(bench.queue.empty());
}

TEST(RequestQueue, AnswersAStopAtOnceAndTellsWhereItStood) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  bench.take(1, "RMAC_CAM.Ok", "[]", 0);
  bench.take(2, "RMAC_CAM.StopNow", "[]", 60);
  EXPECT_EQ(bench.answered(), (Ids{2}));
  EXPECT_EQ(bench.client.stops, (std::vector<std::pair<std::string, std::uint64_t>>{{"RMAC_CAM.StopNow", 60}}));
}

TEST(RequestQueue, AStopThatWasNoneStopsNobody) {
  QueueBench bench;
  bench.take(1, "RMAC_CAM.StopNow", R"({"speed":5})");
  EXPECT_TRUE(bench.client.answers.at(0).contains("error"));
  EXPECT_TRUE(bench.client.stops.empty());
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now())
      .WillOnce(Return(failure(MinorCode::CommTimeout, "the bus is silent")));
  bench.take(2, "RMAC_CAM.StopNow");
  EXPECT_EQ(bench.client.stops.size(), 1U)
      << "the machine was asked to, and refused: what is queued must not start all the same";
}

TEST(RequestQueue, RefusesAStartThatStandsBeforeAStop) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, start(_)).WillOnce(Return(Expected<>{}));
  bench.take(1, "RMAC_CAM.CycleStart", "[1]", 99);
  bench.take(2, "RMAC_CAM.CycleStart", "[1]", 100);
  bench.queue.stopped(Effect::Holds, "RMAC_CAM.FeedHold of panel", 100);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.client.answers[0]["error"]["message"],
            "RMAC_CAM.CycleStart was overtaken by a stop: RMAC_CAM.FeedHold of panel came before it was carried out; "
            "send it again if it still holds");
  EXPECT_EQ(bench.client.answers[1]["result"], true);
}

TEST(RequestQueue, AMoveWaitsForRoomAndWhatIsBehindItWaitsToo) {
  QueueBench bench;
  bench.machine.now.state = CycleState::Running;
  EXPECT_CALL(bench.machine.cam_mock.queue_mock, add(_, _))
      .WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")))
      .WillOnce(Return(Expected<>{}));
  bench.take_move(1);
  bench.take(2, "RMAC_CAM.Ok");
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
  EXPECT_TRUE(bench.client.answers.empty());
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.answered(), (Ids{1, 2}));
  EXPECT_EQ(bench.dispatcher.status().major, 0) << "waiting is no error of the machine";
}

TEST(RequestQueue, AMoveDoesNotWaitWhereNoRoomWillComeOrNobodyStaysOrTimeIsUp) {
  for (const char* why : {"at rest", "gone", "late"}) {
    SCOPED_TRACE(why);
    QueueBench bench(why == std::string("late") ? std::chrono::milliseconds(0) : std::chrono::hours(1));
    bench.machine.now.state = why == std::string("at rest") ? CycleState::Idle : CycleState::Holding;
    bench.client.here = why != std::string("gone");
    EXPECT_CALL(bench.machine.cam_mock.queue_mock, add(_, _))
        .WillOnce(Return(failure(MinorCode::CommandQueueFull, "full")));
    bench.take_move(1);
    bench.take_move(2);
    EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
    EXPECT_EQ(bench.client.answers[0]["error"]["message"], "full");
    EXPECT_EQ(bench.client.answers[1]["error"]["message"],
              "refused because a move sent before it found the queue full; send both again when there is room");
    EXPECT_EQ(bench.dispatcher.status().minor, static_cast<int>(MinorCode::CommandQueueFull));
  }
}

TEST(RequestQueue, AMoveBehindARefusedOneIsRefusedAndALaterOneIsNot) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.queue_mock, add(_, _))
      .WillOnce(Return(failure(MinorCode::TravelLimit, "too far")))
      .WillOnce(Return(Expected<>{}));
  bench.take_move(1);
  bench.take(2, "RMAC_CAM.Ok");
  bench.take_move(3);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.client.answers[0]["error"]["message"], "too far");
  EXPECT_TRUE(bench.client.answers[1].contains("result"));
  EXPECT_EQ(bench.client.answers[2]["error"]["message"], "refused because a move sent before it was refused: too far");
  bench.take_move(4);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.client.answers[3]["result"], true);
}

TEST(RequestQueue, AMoveBehindAStopIsTakenWhateverTheStopOvertook) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.queue_mock, add(_, _)).WillOnce(Return(Expected<>{}));
  bench.take_move(1, 99);
  bench.take_move(2, 101);
  bench.queue.stopped(Effect::Stops, "RMAC_CAM.StopNow of panel", 100);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_TRUE(bench.client.answers[0].contains("error"));
  EXPECT_EQ(bench.client.answers[1]["result"], true);
}

TEST(RequestQueue, AMoveBehindOneThatIsNoneIsRefused) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.queue_mock, add(_, _)).Times(0);
  bench.take(1, "RMAC_CAM.MoveToPathTarget", R"({"MoveID":1,"TargetFrame":{"p":[0,0,"x"]}})");
  bench.take_move(2);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_TRUE(bench.client.answers[0].contains("error"));
  EXPECT_TRUE(bench.client.answers[1].contains("error"));
}

TEST(RequestQueue, WaitsForASlowRequestAndHoldsItsClientMeanwhile) {
  QueueBench bench;
  bench.take(1, "DeviceDriverManager.SearchDatabaseRecordSet", R"(["SELECT 1"])");
  bench.take(2, "RMAC_CAM.Ok");
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
  EXPECT_GT(bench.client.held.use_count(), 1);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits) << "it is away";
  bench.run_until_back();
  EXPECT_EQ(bench.client.held.use_count(), 1);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.answered(), (Ids{1, 2}));
}

TEST(RequestQueue, LooksAgainForStopsBetweenPreparationAndLoad) {
  QueueBench bench;
  bool loaded = false;
  bench.machine.device_fake.during_load = [&] { loaded = true; };
  bench.take(1, "Device.Load", R"(["Fake"])", 10);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
  bench.run_until_back();
  bench.queue.stopped(Effect::Stops, "RMAC_CAM.StopNow of panel", 100);
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_TRUE(bench.client.answers[0].contains("error"));
  EXPECT_FALSE(loaded);
}

TEST(RequestQueue, PreparesALoadOnceAndThenCarriesItOut) {
  QueueBench bench;
  int prepared = 0;
  bench.machine.device_fake.during_preparation = [&] { ++prepared; };
  bench.take(1, "Device.Load", R"(["Fake"])");
  for (int half = 0; half < 2; ++half) {
    EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
    bench.run_until_back();
  }
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_EQ(bench.client.answers[0]["result"], true);
  EXPECT_EQ(prepared, 1);
}

TEST(RequestQueue, WaitsWhileAnothersRequestHasTheMachine) {
  QueueBench bench;
  ListedClient other;
  RequestQueue others(other, bench.dispatcher, bench.aside, std::chrono::hours(1));
  others.take(R"({"jsonrpc":"2.0","id":1,"method":"Device.Machine_ConfigureMotionPlanner"})", 0);
  EXPECT_EQ(others.carry_out(), Progress::Waits);
  bench.take(1, "RMAC_CAM.Ok");
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
  bench.run_until_back();
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
}

TEST(RequestQueue, DoesNotWaitWhileAnotherSearches) {
  QueueBench bench;
  ListedClient other;
  RequestQueue others(other, bench.dispatcher, bench.aside, std::chrono::hours(1));
  others.take(R"({"jsonrpc":"2.0","id":1,"method":"DeviceDriverManager.SearchDatabaseRecordSet","params":["x"]})", 0);
  EXPECT_EQ(others.carry_out(), Progress::Waits);
  bench.take(1, "RMAC_CAM.Ok");
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  bench.aside.stop();
}

TEST(RequestQueue, ReadsALongLineAsideAndKeepsItsPlace) {
  QueueBench bench;
  EXPECT_CALL(bench.machine.cam_mock.cycle_mock, stop_now()).WillOnce(Return(Expected<>{}));
  bench.queue.take(
      R"({"jsonrpc":"2.0","id":1,"method":"RMAC_CAM.StopNow")" + std::string(RequestLine::kLongBytes, ' ') + "}", 5);
  bench.take(2, "RMAC_CAM.Ok");
  EXPECT_EQ(bench.queue.carry_out(), Progress::Waits);
  bench.queue.clear();  // even when its client is gone by then: it was sent
  bench.run_until_back();
  EXPECT_EQ(bench.client.stops.size(), 1U);
}

TEST(RequestQueue, DropsWhatWaits) {
  QueueBench bench;
  bench.take(1, "RMAC_CAM.Ok");
  bench.queue.clear();
  EXPECT_TRUE(bench.queue.empty());
  EXPECT_EQ(bench.queue.carry_out(), Progress::Done);
  EXPECT_TRUE(bench.client.answers.empty());
}

}  // namespace
}  // namespace rmac::gateway
