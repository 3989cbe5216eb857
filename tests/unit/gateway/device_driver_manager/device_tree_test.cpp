#include <gmock/gmock.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "gateway/controller/controller.hpp"
#include "gateway/device_driver/device_host.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"
#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The repository's device tree as it is built, its drives simulated where a mechanism's are.
class DeviceTree : public testing::Test {
 protected:
  void SetUp() override {
    const auto* test = testing::UnitTest::GetInstance()->current_test_info();
    std::string name = std::string(test->test_suite_name()) + test->name();
    std::replace(name.begin(), name.end(), '/', '-');
    folder_ = fs::temp_directory_path() / (name + "-" + std::to_string(::getpid()));
    fs::create_directories(folder_);
    ControllerOptions options;
    options.module_folders = {(tree_ / "modules").string()};
    options.as_fast_as_computed = true;
    controller_ = std::make_unique<Controller>(options);
    controller_->on_event([this](const Event& event) {
      if (event.kind == Event::Kind::MoveDone) ++done_;
      if (event.kind == Event::Kind::Fault) fault_ = event.message;
    });
    controller_->on_sample([this](const CycleSample& sample) { watch(sample); });
    ASSERT_TRUE(controller_->start());
    ASSERT_NO_FATAL_FAILURE(open(tree_));
  }
  void open(const fs::path& tree) {
    host_.reset();
    auto manager = DeviceDriverManager::open({tree, (folder_ / "drivers.sqlite").string()});
    ASSERT_TRUE(manager) << manager.error().message;
    manager_ = std::move(*manager);
    host_ = std::make_unique<DeviceHost>(*manager_, *controller_);
  }
  /// A mechanism of the tree alone, on axes of which motor and load are one, and whose encoders are right.
  void open_on_rigid_axes(const std::string& mechanism) {
    const fs::path tree = folder_ / "drivers";
    fs::create_directories((tree / mechanism).parent_path());
    fs::copy(tree_ / mechanism, tree / mechanism, fs::copy_options::recursive);
    const fs::path file = tree / mechanism / "device.json";
    auto device = nlohmann::json::parse(std::ifstream(file));
    for (const char* bends : {"stiffness_nm_rad", "load_inertia_kg_m2", "presliding_turns", "cogging", "torque_ripple",
                              "encoder_noise_counts", "encoder_interpolation_counts"}) {
      device["DigitalControlInterface"]["Parameters"].erase(bends);
    }
    for (auto& actuator : device["Actuators"]) actuator.erase("Cogging");
    std::ofstream(file) << device;
    ASSERT_NO_FATAL_FAILURE(open(tree));
  }
  void TearDown() override {
    host_.reset();
    controller_.reset();
    manager_.reset();
    fs::remove_all(folder_);
  }

  void watch(const CycleSample& sample) {
    if (!sample.moving) return;
    for (std::size_t j = 0; j < sample.joint_count; ++j) {
      largest_error_[j] = std::max(largest_error_[j], std::abs(sample.position[j] - sample.position_set[j]));
    }
  }
  template <typename Reached>
  bool run_until(Reached&& reached) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!reached()) {
      if (std::chrono::steady_clock::now() > give_up) return false;
      controller_->dispatch();
      std::this_thread::yield();
    }
    return true;
  }
  void load(const std::string& name, bool virtual_mode) {
    const auto loaded = host_->load(name, virtual_mode);
    ASSERT_TRUE(loaded) << loaded.error().message;
    const auto started = controller_->cam().path().set_feedrate(1500).and_then(
        [&] { return controller_->cam().cycle().start(sdk::CycleMode::Automatic); });
    ASSERT_TRUE(started) << started.error().message;
  }
  void move(const Geometry& geometry) {
    const int before = done_;
    const auto queued = controller_->cam().queue().add(1, geometry);
    ASSERT_TRUE(queued) << queued.error().message;
    EXPECT_TRUE(run_until([&] { return done_ > before || !fault_.empty(); }));
    EXPECT_EQ(fault_, "");
  }

  const fs::path tree_ = fs::path(RMAC_BINARY_DIR) / "drivers";
  fs::path folder_;
  std::unique_ptr<DeviceDriverManager> manager_;
  std::unique_ptr<Controller> controller_;
  std::unique_ptr<DeviceHost> host_;
  int done_ = 0;
  std::string fault_;
  std::array<double, kMaxJoints> largest_error_{};
};

class EveryMechanism : public DeviceTree, public testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(OnSimulatedDrives, EveryMechanism,
                         testing::Values("DMACXYZ", "DMACXY", "BenchXYZ", "SuginoXYZ", "SuginoXYZAC", "DMACXYZA",
                                         "TarusXYZCATwin"));

TEST_P(EveryMechanism, LoadsAndMovesEachOfItsJoints) {
  ASSERT_NO_FATAL_FAILURE(load(GetParam(), false));
  const std::vector<sdk::Joint> joints = controller_->mechanism()->joints;
  const bool late = controller_->mechanism()->digital_control_interface.numbers.contains("late_answers");
  std::vector<double> there;
  for (std::size_t j = 0; j < joints.size(); ++j) there.push_back(20 + 5 * static_cast<double>(j));
  ASSERT_NO_FATAL_FAILURE(move(JointTargetGeometry{there}));
  const CycleSample now = controller_->sample();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    EXPECT_NEAR(now.position[j], there[j], 0.05) << joints[j].limits.name;
    // Late answers are off by what a joint goes in a cycle.
    EXPECT_LT(largest_error_[j], 0.1 + (late ? 0.001 * joints[j].limits.max_speed : 0)) << joints[j].limits.name;
  }
}

TEST_P(EveryMechanism, TurnsItsSpindleAtFullSpeed) {
  ASSERT_NO_FATAL_FAILURE(load(GetParam(), false));
  const sdk::Spindle spindle = controller_->mechanism()->spindles.at(0);
  ASSERT_TRUE(controller_->cam().spindles().set_rpm(0, spindle.max_speed_rpm));
  EXPECT_TRUE(run_until([&] {
    return std::abs(controller_->sample().spindle_rpm[0] - spindle.max_speed_rpm) <= spindle.speed_tolerance_rpm;
  }));
}

TEST_P(EveryMechanism, MovesItsTipWithItsToolUprightWhereATurnIsFree) {
  ASSERT_NO_FATAL_FAILURE(load(GetParam(), true));
  const ToolPose at = controller_->sample().pose_set;
  ToolPose there = at;
  there.tip[0] += 10;
  ASSERT_NO_FATAL_FAILURE(move(LineGeometry{at, there}));
  const ToolPose reached = controller_->sample().pose_set;
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(reached.tip[c], there.tip[c], 1e-6);
    EXPECT_NEAR(reached.axis[c], there.axis[c], 1e-9);
  }
}

TEST_F(DeviceTree, MachinesThatShareDrivesChangeOverAndBack) {
  for (const char* name : {"SuginoXYZ", "SuginoXYZAC", "SuginoXYZ", "DMACXYZ", "DMACXYZA", "DMACXYZ"}) {
    ASSERT_NO_FATAL_FAILURE(load(name, false)) << name;
    EXPECT_EQ(controller_->mechanism()->name, name);
  }
}

TEST_F(DeviceTree, TarusNeedsItsBusAndRunsVirtuallyWithoutIt) {
  const auto on_the_bus = host_->load("TarusXYZCA", false);
  if (on_the_bus) GTEST_SKIP() << "can0 and can1 are there, with drives";
  EXPECT_THAT(on_the_bus.error().message, HasSubstr("can0"));
  ASSERT_NO_FATAL_FAILURE(load("TarusXYZCA", true));
  ASSERT_NO_FATAL_FAILURE(move(JointTargetGeometry{{100, -50, 20, 200, 30}}));
  EXPECT_NEAR(controller_->sample().position[3], 200, 1e-9);
}

TEST_F(DeviceTree, CmmIsARoleOfWhateverIsLoaded) {
  for (const char* name : {"DMACXYZ", "SuginoXYZ", "SuginoXYZAC", "DMACXYZA"}) {
    ASSERT_NO_FATAL_FAILURE(load(name, false)) << name;
    const sdk::DeviceObject mill = *controller_->mechanism();
    for (int again = 0; again < 2; ++again) {
      ASSERT_NO_FATAL_FAILURE(load("CMM", false)) << "on " << name;
      const sdk::DeviceObject& cmm = *controller_->mechanism();
      EXPECT_EQ(cmm.name, "CMM");
      EXPECT_EQ(cmm.type, "CMM");
      EXPECT_EQ(cmm.kinematics.name, mill.kinematics.name);
      EXPECT_EQ(cmm.joints.size(), mill.joints.size());
      EXPECT_EQ(cmm.actuators[0].bus, mill.actuators[0].bus);
    }
  }
}

// Where nothing bends between encoder and probe, which would be in the hit.
TEST_F(DeviceTree, CmmAloneMeasuresThePartOfItsOwnFile) {
  ASSERT_NO_FATAL_FAILURE(open_on_rigid_axes("cmm/3-axis/CMM"));
  ASSERT_NO_FATAL_FAILURE(load("CMM", false));
  EXPECT_EQ(controller_->mechanism()->actuators[0].bus, "sugino0");
  sdk::Measuring& measuring = controller_->measuring();
  // Its block's top is at -20, the tip's radius 1 mm, and (15, 0) beside the bore.
  const auto there = controller_->cam().cmm_moves().to_point(1, {15, 0, -10}, 20);
  ASSERT_TRUE(there) << there.error().message;
  ASSERT_TRUE(run_until([&] { return controller_->cam().queue().moves_left() == 0; }));
  const auto queued = measuring.auto_measure(2, {15, 0, -19}, 20);
  ASSERT_TRUE(queued) << queued.error().message;
  ASSERT_TRUE(run_until([&] { return controller_->cam().queue().moves_left() == 0; }));
  ASSERT_TRUE(measuring.new_hit());
  EXPECT_NEAR(measuring.last_hit()->pose.tip[2], -19, 1.2e-4);
}

TEST_F(DeviceTree, TwinHasTheValuesOfItsMachine) {
  const auto file = [](const char* folder) {
    return nlohmann::json::parse(std::ifstream(std::string(RMAC_SOURCE_DIR "/drivers/") + folder + "/device.json"));
  };
  const auto machine = file("mill/5-axis/TarusXYZCA");
  auto twin = file("bench/5-axis/TarusXYZCATwin");
  for (auto& joint : twin["Joints"]) joint["ServoControlLaw"]["Module"] = "TarusXYZCAPFFServoControlLaw";
  for (const char* key : {"Joints", "Kinematics", "ActuatorMap", "MaxFeedrate", "WorkingVolume"}) {
    EXPECT_EQ(twin[key], machine[key]) << key;
  }
  ASSERT_EQ(twin["Actuators"].size(), machine["Actuators"].size());
  for (std::size_t i = 0; i < twin["Actuators"].size(); ++i) {
    for (const char* key : {"CountsPerRevolution", "RatedTorque", "Direction", "HomeCounts", "Cogging"}) {
      EXPECT_EQ(twin["Actuators"][i][key], machine["Actuators"][i][key]) << key << " of actuator " << i;
    }
  }
  // And the axes of the models of its buses: three of each, the spindle last of the machine's and fourth of the twin's.
  const auto& models = machine["DigitalControlInterface"]["Parameters"];
  const auto& plants = twin["DigitalControlInterface"]["Parameters"];
  for (const char* key : {"rated_torque_nm", "inertia_kg_m2", "friction_nm", "counts_per_revolution",
                          "stiffness_nm_rad", "load_inertia_kg_m2", "presliding_turns", "cogging", "torque_ripple",
                          "encoder_noise_counts", "encoder_interpolation_counts"}) {
    auto axes = models[std::string("can0.model.") + key];
    const auto& head = models[std::string("can1.model.") + key];
    for (const std::size_t i : {2U, 0U, 1U}) axes.push_back(head[i]);
    EXPECT_EQ(plants[key], axes) << key;
  }
  for (const char* key : {"spindle_max_rpm", "spindle_max_torque_nm", "late_answers"}) {
    EXPECT_EQ(plants[key], models[std::string("can1.model.") + key]) << key;
  }
}

}  // namespace
}  // namespace rmac::gateway
