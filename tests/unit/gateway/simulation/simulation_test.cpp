#include "gateway/simulation/simulation.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <cmath>
#include <fstream>

#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

const fs::path kTree = fs::path(RMAC_BINARY_DIR) / "drivers";
const fs::path kSourceTree = fs::path(RMAC_SOURCE_DIR) / "drivers";

class Simulated : public testing::Test {
 protected:
  void load(const std::string& machine) {
    auto opened =
        Simulation::open({.device_tree = kTree, .searcher = fs::path(RMAC_BINARY_DIR) / "bin/rmac-search"}, machine);
    ASSERT_TRUE(opened) << opened.error().message;
    simulation_ = std::move(*opened);
    simulation_->controller().on_sample([this](const CycleSample& sample) {
      if (sample.moving) trace_.push_back(sample);
    });
  }
  Json call(const std::string& method, Json params = Json::object()) {
    const Answer answer = simulation_->call(method, std::move(params));
    EXPECT_TRUE(answer) << method << ": " << answer.error().message;
    return answer.value_or(Json());
  }
  /// Runs what is queued; false when it has not come to its end after a minute of machine time.
  bool run() {
    for (int i = 0; i < 60'000; ++i) {
      simulation_->cycle();
      if (simulation_->controller().cam().queue().moves_left() == 0 && !simulation_->controller().sample().moving) {
        return true;
      }
    }
    return false;
  }
  Json line(double x) { return {{"MoveID", 1}, {"TargetFrame", {{"p", {x, 0, 0}}, {"axis", {0, 0, 1}}}}}; }

  std::unique_ptr<Simulation> simulation_;
  std::vector<CycleSample> trace_;
};

TEST_F(Simulated, MovesWithinTheMachinesLimitsAndArrives) {
  load("BenchXYZ");
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 12000}});
  call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
  call("RMAC_CAM.MoveToPathTarget", line(40));
  ASSERT_TRUE(run());
  ASSERT_GT(trace_.size(), 10U);
  EXPECT_NEAR(trace_.back().position_set[0], 40, 1e-6);
  for (std::size_t i = 1; i < trace_.size(); ++i) {
    EXPECT_LE(std::abs(trace_[i].velocity_set[0]), 200);
    EXPECT_LE(std::abs(trace_[i].acceleration_set[0]), 1000);
    EXPECT_LE(std::abs(trace_[i].acceleration_set[0] - trace_[i - 1].acceleration_set[0]), 10.01);
  }
  // Ramps of tj = 0.1 s to 1000 mm/s² and back, d = a ta (ta + tj) = 40 mm, T = 2 (ta + tj): 0.5123 s at least.
  EXPECT_GE(static_cast<double>(trace_.size()) * 0.001, 0.512);
  EXPECT_LE(static_cast<double>(trace_.size()) * 0.001, 0.53);
}

// Red when a helix is cut into lines, climbs unevenly, or is planned without its rise.
TEST_F(Simulated, FollowsAHelixExactlyAndWithinItsLimits) {
  load("BenchXYZ");
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 6000}});
  const auto pose = [](double x, double y, double z) { return Json{{"p", {x, y, z}}, {"axis", {0, 0, 1}}}; };
  call("RMAC_CAM.MoveToPathTarget", {{"MoveID", 1}, {"TargetFrame", pose(20, 0, 0)}});
  call("RMAC_CAM.MoveAlongArc", {{"MoveID", 2},
                                 {"RotSign", -1},
                                 {"Closed", false},
                                 {"CenterPoint", pose(0, 0, 0)},
                                 {"StartPoint", pose(20, 0, 0)},
                                 {"EndPoint", pose(0, 20, -14)},
                                 {"Turns", 2}});
  call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
  ASSERT_TRUE(run());
  const double sweep = 2.75 * 2 * M_PI;
  std::size_t on_it = 0;
  double largest_feed = 0;
  std::array<double, 3> last{20, 0, 0};
  for (const CycleSample& sample : trace_) {
    for (std::size_t j = 0; j < 3; ++j) {
      EXPECT_LE(std::abs(sample.velocity_set[j]), 200);
      EXPECT_LE(std::abs(sample.acceleration_set[j]), 1000);
    }
    if (sample.move_id != 2) continue;
    ++on_it;
    largest_feed = std::max(largest_feed, sample.feed_set_mm_s);
    const double angle = -sweep * sample.s_mm / std::hypot(20 * sweep, 14);
    const std::array<double, 3> wanted{20 * std::cos(angle), 20 * std::sin(angle), 14 * angle / sweep};
    for (std::size_t j = 0; j < 3; ++j) {
      ASSERT_NEAR(sample.position_set[j], wanted[j], 1e-9);
      last[j] = sample.position_set[j];
    }
  }
  EXPECT_GT(on_it, 1000U);
  EXPECT_NEAR(largest_feed, 100, 1e-3);
  EXPECT_NEAR(last[0], 0, 1e-6);
  EXPECT_NEAR(last[1], 20, 1e-6);
  EXPECT_NEAR(last[2], -14, 1e-6);
}

// Red when outputs on the way cost time, and when a dwell or a spindle's new speed does not bring the path to rest.
TEST_F(Simulated, TakesNoTimeForOutputsOnTheWay) {
  std::vector<std::size_t> cycles;
  for (const bool with_outputs : {false, true}) {
    trace_.clear();
    load("BenchXYZ");
    call("RMAC_CAM.SetFeedrate", {{"Feedrate", 3000}});
    call("RMAC_CAM.SetPathTolerance", {{"Tolerance", 0.02}});
    double x = 0;
    for (int i = 0; i < 30; ++i) {
      const auto pose = [](double at) { return Json{{"p", {at, at * at / 80, 0}}, {"axis", {0, 0, 1}}}; };
      call("RMAC_CAM.MoveAlongLine", {{"MoveID", 2 * i}, {"StartPoint", pose(x)}, {"EndPoint", pose(x + 1)}});
      x += 1;
      if (!with_outputs) continue;
      const Json one{{"method", i % 2 == 0 ? "RMAC_CAM.TurnCoolantOn" : "RMAC_CAM.TurnCoolantOff"}};
      call("RMAC_CAM.InTurn", {{"MoveID", 2 * i + 1}, {"Calls", Json::array({one})}});
    }
    call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
    ASSERT_TRUE(run());
    cycles.push_back(trace_.size());
  }
  EXPECT_EQ(cycles[0], cycles[1]);
  std::size_t switched = 0;
  for (std::size_t i = 1; i < trace_.size(); ++i) switched += trace_[i].outputs != trace_[i - 1].outputs ? 1U : 0U;
  EXPECT_GE(switched, 28U) << "the last ones fall together with rest, which is not traced";
}

TEST_F(Simulated, RunsTheSameTwice) {
  std::vector<double> first;
  for (int round = 0; round < 2; ++round) {
    trace_.clear();
    load("BenchXYZ");
    call("RMAC_CAM.SetFeedrate", {{"Feedrate", 7000}});
    call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
    call("RMAC_CAM.MoveToPathTarget", line(20));
    call("RMAC_CAM.MoveToPathTarget", line(-20));
    ASSERT_TRUE(run());
    std::vector<double> now;
    for (const CycleSample& sample : trace_) now.push_back(sample.position_set[0]);
    if (round == 0) first = now;
    EXPECT_EQ(now, first);
  }
}

TEST_F(Simulated, DeviceJsonTakesItsModulesFromTheTreeThatHasThem) {
  load((kSourceTree / "mill/3-axis/DMACXYZ/device.json").string());
  EXPECT_EQ(simulation_->controller().mechanism()->name, "DMACXYZ");
  EXPECT_TRUE(simulation_->controller().virtual_mode()) << "no drive is there to be moved";
}

TEST_F(Simulated, DeviceJsonOfACopyIsTheOneThatCounts) {
  const fs::path copy = fs::temp_directory_path() / fmt::format("rmac-simulated-{}.json", ::getpid());
  std::ifstream original(kSourceTree / "bench/3-axis/BenchXYZ/device.json");
  Json device = Json::parse(original);
  device["MechanismName"] = "SlowBench";
  device["Joints"][0]["MaxSpeed"] = 20;
  std::ofstream(copy) << device;
  load(copy.string());
  fs::remove(copy);
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 12000}});
  call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
  call("RMAC_CAM.MoveToPathTarget", line(10));
  ASSERT_TRUE(run());
  double peak = 0;
  for (const CycleSample& sample : trace_) peak = std::max(peak, sample.velocity_set[0]);
  EXPECT_NEAR(peak, 20, 0.1);
}

TEST_F(Simulated, ChangesOfTheConfigurationCount) {
  load("BenchXYZ");
  call("RMAC_Config.SetMechanismJointMaximumSpeed", {{"JntNum", 0}, {"MaxJntSpeed", 30}});
  call("RMAC_Config.Apply");
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 12000}});
  call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
  call("RMAC_CAM.MoveToPathTarget", line(10));
  ASSERT_TRUE(run());
  double peak = 0;
  for (const CycleSample& sample : trace_) peak = std::max(peak, sample.velocity_set[0]);
  EXPECT_NEAR(peak, 30, 0.1);
}

TEST_F(Simulated, AnotherMechanismGoesInWhereTheMachineStandsAndNoBusIsTouched) {
  load("DMACXYZ");
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 2000}});
  call("RMAC_CAM.CycleStart", {{"Mode", "AUTOMATIC"}});
  call("RMAC_CAM.MoveToPathTarget", line(7));
  ASSERT_TRUE(run());
  call("Device.Load", {{"Name", "DMACXY"}});
  EXPECT_NEAR(simulation_->controller().sample().position_set[0], 7, 1e-9);
  EXPECT_EQ(simulation_->controller().mechanism()->name, "DMACXY");
  EXPECT_TRUE(simulation_->controller().virtual_mode());
}

TEST_F(Simulated, SearchesTheDeviceTree) {
  load("BenchXYZ");
  call("DeviceDriverManager.OpenDeviceDriverDatabase");
  EXPECT_EQ(call("DeviceDriverManager.SearchDatabaseRecordSet",
                 {{"MachineSQLStatement", "SELECT * FROM DeviceDrivers WHERE Type = 'Bench' AND NumberOfJoints = 3"}}),
            1);
}

TEST_F(Simulated, RefusalNamesJointAmountAndPlace) {
  load("BenchXYZ");
  call("RMAC_CAM.SetFeedrate", {{"Feedrate", 6000}});
  const Answer answer = simulation_->call("RMAC_CAM.MoveToPathTarget", line(51.5));
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().message, AllOf(HasSubstr("joint X"), HasSubstr("1.5000 mm beyond"), HasSubstr("along")));
}

TEST(SimulationOpen, RefusesAMachineThatIsNotThere) {
  const auto unknown = Simulation::open({.device_tree = kTree}, "Nonsense");
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, AllOf(HasSubstr("Nonsense"), HasSubstr("BenchXYZ")));
  const auto missing = Simulation::open({.device_tree = kTree}, "/nonexistent/device.json");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("/nonexistent/device.json"));
}

}  // namespace
}  // namespace rmac::gateway
