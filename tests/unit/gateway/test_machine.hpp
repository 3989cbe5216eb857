#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <thread>

#include "gateway/controller/controller.hpp"
#include "places.hpp"
#include "rmac/fieldbus/simulated_interface.hpp"
#include "rmac/fieldbus/simulated_io_interface.hpp"
#include "rmac/motion/servo/servo_bus.hpp"
#include "rmac/motion/servo/servo_loop.hpp"

namespace rmac::gateway {

/// The controller in virtual time with a simulated bus that the test can reach, and device objects for it.
class TestMachine {
 public:
  TestMachine() : TestMachine(options()) {}
  explicit TestMachine(ControllerOptions controller_options) : controller(with_interfaces(controller_options)) {
    controller.on_event([this](const Event& event) { events.push_back(event); });
    controller.on_sample([this](const CycleSample& sample) { samples.push_back(sample); });
    const auto started = controller.start();
    EXPECT_TRUE(started) << started.error().message;
  }

  static ControllerOptions options() {
    ControllerOptions virtual_time;
    virtual_time.module_folders = {(std::filesystem::path(RMAC_BINARY_DIR) / "test_modules" / "good").string()};
    virtual_time.as_fast_as_computed = true;
    return virtual_time;
  }

  static sdk::Joint joint(const std::string& name) {
    sdk::Joint made;
    made.limits = {name, JointType::Linear, JointLimitType::Limited, -50, 50, 200, 1000, 10000};
    made.servo_law = {"TestLaw", {}, {}};
    made.gains = {300, 4};
    made.max_following_error = 2;
    made.max_effort = 800;
    return made;
  }

  /// Three axes and a spindle on bus "test".
  static sdk::DeviceObject mill() {
    sdk::DeviceObject device;
    device.name = "Mill";
    device.max_feedrate_mm_min = 12000;
    for (const char* name : {"X", "Y", "Z"}) device.joints.push_back(joint(name));
    for (std::uint32_t axis = 0; axis < 3; ++axis) device.actuators.push_back({"test", axis, {131072, 0.318, 1, 0}});
    device.spindles.push_back({"test", 3, 1000, 5, 2.5, 20, 5});
    device.kinematics = {"TestKinematics3", {}, {}};
    device.actuator_map = {"TestMap", {{"joints", {3}}}, {}};
    device.digital_control_interface = {"TestBus", {}, {}};
    device.digital_io_interface = {"TestIo", {}, {}};
    device.outputs = {{"Coolant", 5}};
    return device;
  }

  /// The same machine on two of its axes; the third holds.
  static sdk::DeviceObject plane_mill() {
    sdk::DeviceObject device = mill();
    device.name = "PlaneMill";
    device.held_joints = {device.joints[2]};
    device.joints.pop_back();
    device.kinematics.name = "TestKinematics2";
    return device;
  }

  /// What a device driver does: every value of `device` goes into the draft through its setter.
  Expected<> draft(const sdk::DeviceObject& device);
  Expected<> load(const sdk::DeviceObject& device) {
    return draft(device).and_then([&] { return controller.config().apply(); });
  }

  /// Puts a mill in and its joints at zero: where drives were enabled, they hold what they measured, which is near.
  Expected<> load_at_zero(const sdk::DeviceObject& device);

  /// Hands events and samples out until `reached`; false when four minutes did not do.
  template <typename Reached>
  bool run_until(Reached&& reached) {
    // A disk that writes for others may take a minute for a record.
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::minutes(4);
    while (!reached()) {
      if (std::chrono::steady_clock::now() > give_up) return false;
      controller.dispatch();
      std::this_thread::yield();
    }
    return true;
  }
  bool run_until_event(Event::Kind kind, std::int64_t move_id = 0) {
    return run_until([&] { return count(kind, move_id) > 0; });
  }
  [[nodiscard]] int count(Event::Kind kind, std::int64_t move_id = 0) const {
    int found = 0;
    for (const Event& event : events) found += event.kind == kind && event.move_id == move_id ? 1 : 0;
    return found;
  }
  /// Message of the last event of a kind, or empty.
  [[nodiscard]] std::string last(Event::Kind kind) const {
    std::string message;
    for (const Event& event : events) message = event.kind == kind ? event.message : message;
    return message;
  }
  Expected<> line(std::int64_t id, const Vector& from, const Vector& to) {
    return controller.cam().queue().add(id, LineGeometry{{from, {0, 0, 1}}, {to, {0, 0, 1}}});
  }
  [[nodiscard]] double peak_velocity(std::size_t joint_number) const {
    double peak = 0;
    for (const CycleSample& sample : samples) peak = std::max(peak, std::abs(sample.velocity_set[joint_number]));
    return peak;
  }

  std::shared_ptr<fieldbus::SimulatedInterface> bus;
  std::shared_ptr<fieldbus::SimulatedIoInterface> io;
  std::string bus_trouble;  ///< the next bus to be made fails to come up with this
  std::vector<Event> events;
  std::vector<CycleSample> samples;
  Controller controller;  ///< last: it ends before what it reports to

 private:
  ControllerOptions with_interfaces(ControllerOptions controller_options);
};

}  // namespace rmac::gateway
