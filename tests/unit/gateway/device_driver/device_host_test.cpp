#include "gateway/device_driver/device_host.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>

#include "places.hpp"

namespace rmac::gateway {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The device tree as it was built, copied so that a test may spoil it.
class Host : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("rmac-device-host-" + std::to_string(::getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    fs::copy(fs::path(RMAC_BINARY_DIR) / "drivers", folder_ / "drivers", fs::copy_options::recursive);
    auto manager = DeviceDriverManager::open({folder_ / "drivers", (folder_ / "drivers.sqlite").string()});
    ASSERT_TRUE(manager) << manager.error().message;
    manager_ = std::move(*manager);
    ControllerOptions options;
    options.module_folders = {(folder_ / "drivers" / "modules").string()};
    options.as_fast_as_computed = true;
    controller_ = std::make_unique<Controller>(options);
    ASSERT_TRUE(controller_->start());
    host_ = std::make_unique<DeviceHost>(*manager_, *controller_);
  }
  void TearDown() override {
    host_.reset();
    controller_.reset();
    manager_.reset();
    fs::remove_all(folder_);
  }
  void replace_in_device_json(const std::string& mechanism, const std::string& from, const std::string& to) {
    const fs::path file = *manager_->folder_of(mechanism) / "device.json";
    std::stringstream text;
    text << std::ifstream(file).rdbuf();
    std::string content = text.str();
    const std::size_t at = content.find(from);
    ASSERT_NE(at, std::string::npos);
    content.replace(at, from.size(), to);
    std::ofstream(file) << content;
  }

  fs::path folder_;
  std::unique_ptr<DeviceDriverManager> manager_;
  std::unique_ptr<Controller> controller_;
  std::unique_ptr<DeviceHost> host_;
};

TEST_F(Host, LoadsOneMechanismAfterAnother) {
  const auto first = host_->load("DMACXYZ", false);
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(controller_->mechanism()->joints.size(), 3U);
  const auto second = host_->load("DMACXY", false);
  ASSERT_TRUE(second) << second.error().message;
  EXPECT_EQ(controller_->mechanism()->joints.size(), 2U);
  EXPECT_EQ(controller_->mechanism()->held_joints.size(), 1U);
  ASSERT_TRUE(host_->unload());
  EXPECT_FALSE(host_->loaded());
}

TEST_F(Host, HasTheDriverOfTheMachineConfigureItUnderAnOverlayToo) {
  replace_in_device_json("DMACXYZ", R"("DeviceDriver": "DMACXYZ")", R"("DeviceDriver": "CarefulDriver")");
  fs::copy(fs::path(RMAC_BINARY_DIR) / "test_modules/good/CarefulDriver.so", *manager_->folder_of("DMACXYZ"));
  const auto mill = host_->load("DMACXYZ", false);
  ASSERT_TRUE(mill) << mill.error().message;
  ASSERT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 100) << "half of what its file says";
  for (int again = 0; again < 2; ++again) {
    const auto overlay = host_->load("CMM", false);
    ASSERT_TRUE(overlay) << overlay.error().message;
    EXPECT_EQ(controller_->mechanism()->name, "CMM");
    EXPECT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 100);
  }
  const auto modules = host_->modules();
  ASSERT_TRUE(modules);
  EXPECT_EQ((*modules)[0].role + " " + (*modules)[0].module, "device driver CMM");
  EXPECT_EQ((*modules)[1].role + " " + (*modules)[1].module, "low-level device driver CarefulDriver");
  (*host_->wanted())->joints[0].limits.max_speed = 60;
  ASSERT_TRUE(host_->configure_motion_planner());
  EXPECT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 30);
}

/// A host whose verifier passes everything, at once.
class VerifiedHost : public Host {
 protected:
  void SetUp() override {
    Host::SetUp();
    const fs::path program = folder_ / "verifier";
    std::ofstream(program) << "#!/bin/sh\n"
                              R"(echo '{"mechanism": "", "file": "", "samples": 1, "seed": 1, "modules": []}')"
                              "\n";
    fs::permissions(program, fs::perms::owner_all);
    verification_ = std::make_unique<Verification>(Verification::Options{program, {}, {}, std::chrono::seconds(60)});
    host_ = std::make_unique<DeviceHost>(*manager_, *controller_, verification_.get());
    ASSERT_TRUE(host_->load("DMACXYZ", false));
  }
  sdk::RmacConfig& config() { return controller_->config(); }

  std::unique_ptr<Verification> verification_;
};

// Red when what was verified is not what runs: wider travel took an arm past its own length.
TEST_F(VerifiedHost, PutsNothingInThatIsMoreThanWasVerified) {
  const JointLimits verified = controller_->mechanism()->joints[1].limits;
  const std::vector<std::function<Expected<>()>> more{
      [&] { return config().joints().set_maximum_limit(1, verified.max + 0.1); },
      [&] { return config().joints().set_minimum_limit(1, verified.min - 0.1); },
      [&] { return config().joints().set_limit_type(1, JointLimitType::InfinitePositive); },
      [&] { return config().joints().set_maximum_speed(1, verified.max_speed * 1.01); },
      [&] { return config().joints().set_maximum_acceleration(1, verified.max_acceleration * 1.01); },
      [&] { return config().joints().set_maximum_jerk(1, verified.max_jerk * 1.01); },
      [&] {
        return config().mechanism().set_kinematics({"ChainKinematics", {{"offset", {1}}}, {}});
      },
      [&] {
        return config().mechanism().set_actuator_map({"TransmissionMap", {{"t1", {1, 2}}}, {}});
      }};
  for (std::size_t i = 0; i < more.size(); ++i) {
    ASSERT_TRUE(more[i]()) << i;
    const auto done = config().apply();
    ASSERT_FALSE(done) << i;
    EXPECT_THAT(done.error().message, HasSubstr(i < 6 ? "Device.Verify" : "verified before they put it in force")) << i;
    EXPECT_EQ(host_->verification_of_draft() == nullptr, i < 6) << i << ": no verifier sees where a slide ends";
    controller_->discard_draft();
  }
  EXPECT_EQ(controller_->mechanism()->joints[1].limits.max, verified.max);
  EXPECT_EQ(controller_->mechanism()->joints[1].limits.max_speed, verified.max_speed);
}

TEST_F(VerifiedHost, TellsWhatWasVerifiedAndHowToHaveMore) {
  const JointLimits verified = controller_->mechanism()->joints[1].limits;
  ASSERT_TRUE(config().joints().set_maximum_limit(1, 250));
  EXPECT_EQ(config().apply().error().message,
            fmt::format("joint {}: the maximum limit 250 is beyond {}, which was verified. What the joints of DMACXYZ "
                        "can is for its device.json to say: change that file, have it verified (Device.Verify) and "
                        "load it anew (Device.Load)",
                        verified.name, verified.max));
}

TEST_F(VerifiedHost, PutsInWhatWasVerifiedAsADraft) {
  // A part of the machine: without its third axis.
  ASSERT_TRUE(config().mechanism().set_number_of_joints(2));
  ASSERT_TRUE(config().mechanism().set_number_of_actuators(2));
  ASSERT_TRUE(config().mechanism().set_kinematics({"ChainKinematics", {}, {{"joints", "X Y"}}}));
  ASSERT_TRUE(config().mechanism().set_actuator_map(
      {"TransmissionMap", {{"t1", {5, 1}}, {"t2", {5, 1}}}, {{"transmissions", "screw screw"}}}));
  const auto job = host_->verification_of_draft();
  ASSERT_TRUE(job);
  EXPECT_FALSE(config().apply()) << "not before";
  const auto passed = job();
  ASSERT_TRUE(passed) << passed.error().message;
  const auto done = config().apply();
  ASSERT_TRUE(done) << done.error().message;
  EXPECT_EQ(controller_->mechanism()->joints.size(), 2U);
  EXPECT_FALSE(host_->verification_of_draft()) << "once is enough";
}

TEST_F(VerifiedHost, GoesBackToWhatWasVerifiedAfterLess) {
  const JointLimits verified = controller_->mechanism()->joints[1].limits;
  for (const double max : {verified.max / 2, verified.max}) {
    ASSERT_TRUE(config().joints().set_maximum_limit(1, max));
    const auto done = config().apply();
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(controller_->mechanism()->joints[1].limits.max, max);
  }
}

TEST_F(VerifiedHost, HoldsWhatStaysLoadedToItsOwnVerification) {
  replace_in_device_json("SuginoXYZ", "\"Module\": \"ChainKinematics\"", "\"Module\": \"LostKinematics\"");
  ASSERT_FALSE(host_->load("SuginoXYZ", false));
  const double verified = controller_->mechanism()->joints[1].limits.max;
  ASSERT_TRUE(config().joints().set_maximum_limit(1, verified + 1));
  EXPECT_FALSE(config().apply());
  controller_->discard_draft();
  ASSERT_TRUE(config().joints().set_maximum_limit(1, verified));
  const auto done = config().apply();
  EXPECT_TRUE(done) << done.error().message;
}

// Red when an overlay moves as fast as the machine below may, or as it may itself.
TEST_F(Host, MovesAnOverlayWithTheLowerOfBothFeeds) {
  replace_in_device_json("CMM", "\"MaxFeedrate\": 2000", "\"MaxFeedrate\": 900");
  ASSERT_TRUE(host_->load("DMACXYZ", false));
  ASSERT_TRUE(host_->load("CMM", false));
  EXPECT_EQ(controller_->mechanism()->max_feedrate_mm_min, 900);
  replace_in_device_json("DMACXYZ", "\"MaxFeedrate\": 2000", "\"MaxFeedrate\": 700");
  ASSERT_TRUE(host_->load("DMACXYZ", false));
  ASSERT_TRUE(host_->load("CMM", false));
  EXPECT_EQ(controller_->mechanism()->max_feedrate_mm_min, 700);
}

TEST_F(Host, KeepsTheLoadedMechanismWhenAnotherCannotBeLoaded) {
  ASSERT_TRUE(host_->load("DMACXYZ", false));
  replace_in_device_json("SuginoXYZ", "\"Module\": \"ChainKinematics\"", "\"Module\": \"LostKinematics\"");
  const auto missing = host_->load("SuginoXYZ", false);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("no file"));
  EXPECT_THAT(missing.error().message, HasSubstr("DMACXYZ stays loaded"));
  replace_in_device_json("DMACXY", "\"MaxFeedrate\": ", "\"MaxFeedrate\": -");
  const auto bad_value = host_->load("DMACXY", false);
  ASSERT_FALSE(bad_value);
  EXPECT_THAT(bad_value.error().message, HasSubstr("MaxFeedrate"));
  EXPECT_FALSE(host_->load("Nowhere", false));
  EXPECT_EQ(controller_->mechanism()->name, "DMACXYZ");
  EXPECT_EQ((*host_->database())->name, "DMACXYZ");
}

TEST_F(Host, WhatIsWantedActsOnceItIsConfigured) {
  ASSERT_TRUE(host_->load("DMACXYZ", false));
  (*host_->wanted())->joints[0].limits.max_speed = 42;
  EXPECT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 200);
  const auto configured = host_->configure_motion_planner();
  ASSERT_TRUE(configured) << configured.error().message;
  EXPECT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 42);
  (*host_->wanted())->joints[0].gains.push_back(1);
  EXPECT_FALSE(host_->configure_servo_controller());
  EXPECT_EQ(controller_->mechanism()->joints[0].limits.max_speed, 42);
}

TEST_F(Host, NeedsALoadedDriver) {
  EXPECT_FALSE(host_->database());
  EXPECT_FALSE(host_->move(1, JointTargetGeometry{{0, 0, 0}}));
  EXPECT_FALSE(host_->configure_motion_planner());
}

}  // namespace
}  // namespace rmac::gateway
