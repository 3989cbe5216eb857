#include "gateway/requests/machine_aside.hpp"

#include <gtest/gtest.h>

#include <future>
#include <thread>

#include "unit/gateway/api/session.hpp"

namespace rmac::gateway {
namespace {

Request request_of(const std::string& method, const std::string& params) {
  return read_request({{"jsonrpc", "2.0"}, {"id", 1}, {"method", method}, {"params", nlohmann::json::parse(params)}});
}

struct AsideBench {
  /// Runs the gateway's thread until `done`.
  void run_until(const bool& done) {
    io.restart();  // it stopped when the last work was done
    const auto working = asio::make_work_guard(io);
    while (!done) io.run_one();
  }

  fakes::FakeMachine machine;
  Dispatcher dispatcher{machine};
  fakes::FakeSession session;
  asio::io_context io;
  int back = 0;
  MachineAside aside{io, dispatcher, [this] { ++back; }};
};

TEST(MachineAside, RunsWorkOnAnotherThreadAndComesBackToTheGateways) {
  AsideBench bench;
  std::thread::id worked, came_back;
  bool done = false;
  bench.aside.run([&] { worked = std::this_thread::get_id(); },
                  [&] {
                    came_back = std::this_thread::get_id();
                    done = true;
                  });
  EXPECT_FALSE(bench.aside.is_away()) << "it needs nothing of the machine";
  bench.run_until(done);
  EXPECT_NE(worked, std::this_thread::get_id());
  EXPECT_EQ(came_back, std::this_thread::get_id());
}

TEST(MachineAside, HasTheMachineAwayUntilTheAnswerIsThere) {
  AsideBench bench;
  const Request request = request_of("Device.Load", R"(["Fake"])");
  bool done = false;
  bench.aside.carry_out(request, bench.session, 4, [&](const Answer& answer) {
    EXPECT_TRUE(answer);
    EXPECT_FALSE(bench.aside.is_away());
    EXPECT_FALSE(bench.aside.mechanism_changes());
    done = true;
    return true;
  });
  EXPECT_TRUE(bench.aside.is_away());
  EXPECT_TRUE(bench.aside.mechanism_changes());
  EXPECT_EQ(bench.aside.last_served(), 4U);
  bench.run_until(done);
  EXPECT_EQ(bench.back, 1) << "whatever waits may go on";
}

TEST(MachineAside, LeavesTheMachineToOthersDuringAPreparation) {
  AsideBench bench;
  const Request load = request_of("Device.Load", R"(["Fake"])");
  bool done = false;
  bench.aside.prepare(load, bench.session, bench.dispatcher.preparation_of(load, bench.session),
                      [&](const std::optional<Answer>& failed) {
                        EXPECT_FALSE(failed);
                        done = true;
                      });
  EXPECT_FALSE(bench.aside.is_away()) << "others are served meanwhile";
  bench.run_until(done);
}

TEST(MachineAside, TellsWhyAPreparationFailedAndKeepsTheMachinesError) {
  AsideBench bench;
  bench.machine.device_fake.verification_refusal = "its module crashes";
  const Request load = request_of("Device.Load", R"(["Fake"])");
  bool done = false;
  bench.aside.prepare(load, bench.session, bench.dispatcher.preparation_of(load, bench.session),
                      [&](const std::optional<Answer>& failed) {
                        EXPECT_TRUE(failed && failed->error().message == "its module crashes");
                        done = true;
                      });
  bench.run_until(done);
  EXPECT_EQ(bench.dispatcher.status().minor, static_cast<int>(MinorCode::InvalidParameterValue));
}

TEST(MachineAside, LetsOthersWaitForTheTickWhenTheAnswerIsNotFinal) {
  AsideBench bench;
  const Request request = request_of("Device.Load", R"(["Fake"])");
  bool done = false;
  bench.aside.carry_out(request, bench.session, 1, [&](const Answer&) {
    done = true;
    return false;
  });
  bench.run_until(done);
  EXPECT_EQ(bench.back, 0);
}

TEST(MachineAside, FinishesWhatIsUnderWayWhenItStops) {
  AsideBench bench;
  std::promise<void> begun, end;
  bool finished = false;
  bench.aside.run(
      [&] {
        begun.set_value();
        end.get_future().wait();
        finished = true;
      },
      [] {});
  begun.get_future().wait();
  end.set_value();
  bench.aside.stop();
  EXPECT_TRUE(finished);
}

}  // namespace
}  // namespace rmac::gateway
