#pragma once

#include <gmock/gmock.h>

#include "gateway/api/ports.hpp"

// Fakes of the API's ports. MockCam and MockConfig check calls; FakeDevice and FakeMachine keep values.

namespace rmac::gateway::fakes {

class MockCam : public sdk::RmacCam {
 public:
  MOCK_METHOD(Expected<>, cycle_start, (sdk::CycleMode), (override));
  MOCK_METHOD(Expected<>, cycle_stop, (), (override));
  MOCK_METHOD(Expected<>, feed_hold, (), (override));
  MOCK_METHOD(Expected<>, feed_resume, (), (override));
  MOCK_METHOD(Expected<double>, feed_retrace, (double), (override));
  MOCK_METHOD(Expected<>, set_joint_force, (int, double), (override));
  MOCK_METHOD(Expected<>, jog_joint_at, (int, double), (override));
  MOCK_METHOD(Expected<>, jog_path, (const sdk::JogDirection&, double), (override));
  MOCK_METHOD(Expected<>, jog_path_at, (const sdk::JogDirection&, double), (override));
  MOCK_METHOD(Expected<>, stop_now, (), (override));
  MOCK_METHOD(Expected<>, reset, (), (override));
  MOCK_METHOD(bool, cycle_start_status, (), (const, override));
  MOCK_METHOD(bool, cycle_stop_status, (), (const, override));
  MOCK_METHOD(Expected<>, queue_move, (std::int64_t, const Geometry&), (override));
  MOCK_METHOD(int, moves_in_buffer, (), (const, override));
  MOCK_METHOD(Expected<std::vector<double>>, joints_at, (const ToolPose&), (const, override));
  MOCK_METHOD(Expected<>, set_feedrate, (double), (override));
  MOCK_METHOD(double, feedrate, (), (const, override));
  MOCK_METHOD(Expected<>, set_max_feedrate, (double), (override));
  MOCK_METHOD(double, max_feedrate, (), (const, override));
  MOCK_METHOD(Expected<>, set_feed_override, (double), (override));
  MOCK_METHOD(Expected<>, set_path_accel_rise, (double), (override));
  MOCK_METHOD(double, path_accel_rise, (), (const, override));
  MOCK_METHOD(Expected<>, set_path_accel_fall, (double), (override));
  MOCK_METHOD(double, path_accel_fall, (), (const, override));
  MOCK_METHOD(Expected<>, set_joint_interp_speed, (double), (override));
  MOCK_METHOD(double, joint_interp_speed, (), (const, override));
  MOCK_METHOD(Expected<>, set_path_tolerance, (double), (override));
  MOCK_METHOD(double, path_tolerance, (), (const, override));
  MOCK_METHOD(Expected<>, set_part_frame, (const Frame&), (override));
  MOCK_METHOD(Frame, part_frame, (), (const, override));
  MOCK_METHOD(Expected<>, set_tool_interface_frame, (const Frame&), (override));
  MOCK_METHOD(Frame, tool_interface_frame, (), (const, override));
  MOCK_METHOD(Expected<>, set_spindle_rpm, (int, double), (override));
  MOCK_METHOD(Expected<double>, spindle_rpm, (int), (const, override));
  MOCK_METHOD(Expected<>, set_spindle_max_rpm, (int, double), (override));
  MOCK_METHOD(Expected<double>, spindle_max_rpm, (int), (const, override));
  MOCK_METHOD(Expected<>, set_coolant, (bool), (override));
  MOCK_METHOD(Expected<>, jog_joint, (int, double), (override));
  MOCK_METHOD(Expected<>, home, (), (override));
  MOCK_METHOD(Expected<>, move_to_reference_point, (), (override));
  MOCK_METHOD(Expected<>, set_joint_accel_rise, (int, double), (override));
  MOCK_METHOD(Expected<double>, joint_accel_rise, (int), (const, override));
  MOCK_METHOD(Expected<>, set_joint_accel_fall, (int, double), (override));
  MOCK_METHOD(Expected<double>, joint_accel_fall, (int), (const, override));
  MOCK_METHOD(Expected<std::vector<double>>, current_position, (), (const, override));
  MOCK_METHOD(Expected<>, set_animation, (bool), (override));
  MOCK_METHOD(Expected<>, park_program, (), (override));
  MOCK_METHOD(Expected<>, take_up_program, (), (override));
  MOCK_METHOD(Expected<>, drop_parked_program, (), (override));
  MOCK_METHOD(std::optional<sdk::ParkedProgram>, parked_program, (), (const, override));
};

class MockMeasuring : public sdk::Measuring {
 public:
  MOCK_METHOD(Expected<>, move_to_point, (std::int64_t, const Vector&, double), (override));
  MOCK_METHOD(Expected<>, move_in_arc, (std::int64_t, const sdk::ArcTo&, double), (override));
  MOCK_METHOD(Expected<>, move_all_axes, (std::int64_t, std::vector<double>, double), (override));
  MOCK_METHOD(Expected<>, move_rotary_axis, (std::int64_t, int, double, int, double), (override));
  MOCK_METHOD(Expected<>, auto_measure, (std::int64_t, const Vector&, double), (override));
  MOCK_METHOD(Expected<>, manual_measure, (), (override));
  MOCK_METHOD(Expected<>, spin_probe, (double, double), (override));
  MOCK_METHOD(Expected<>, simulate_probe, (std::vector<double>, bool), (override));
  MOCK_METHOD(Expected<>, set_calibrated_part_frame, (), (override));
  MOCK_METHOD(Expected<sdk::Hit>, last_hit, (), (override));
  MOCK_METHOD(bool, new_hit, (), (const, override));
  MOCK_METHOD(bool, probe_active, (), (const, override));
  MOCK_METHOD(sdk::ControlMode, control_mode, (), (const, override));
  MOCK_METHOD(Expected<>, set_control_mode, (sdk::ControlMode), (override));
  MOCK_METHOD(double, parameter, (sdk::MeasureParameter), (const, override));
  MOCK_METHOD(Expected<>, set_parameter, (sdk::MeasureParameter, double), (override));
};

class MockConfig : public sdk::RmacConfig {
 public:
  MOCK_METHOD(Expected<>, begin, (const sdk::DeviceObject&), (override));
  MOCK_METHOD(Expected<>, set_kinematics, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_actuator_map, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_number_of_joints, (int), (override));
  MOCK_METHOD(Expected<>, set_number_of_spindles, (int), (override));
  MOCK_METHOD(Expected<>, set_number_of_actuators, (int), (override));
  MOCK_METHOD(Expected<>, set_joint_name, (int, std::string_view), (override));
  MOCK_METHOD(Expected<>, set_joint_type, (int, JointType), (override));
  MOCK_METHOD(Expected<>, set_joint_limit_type, (int, JointLimitType), (override));
  MOCK_METHOD(Expected<>, set_joint_maximum_limit, (int, double), (override));
  MOCK_METHOD(Expected<>, set_joint_minimum_limit, (int, double), (override));
  MOCK_METHOD(Expected<>, set_joint_maximum_speed, (int, double), (override));
  MOCK_METHOD(Expected<>, set_joint_maximum_acceleration, (int, double), (override));
  MOCK_METHOD(Expected<>, set_joint_maximum_jerk, (int, double), (override));
  MOCK_METHOD(Expected<>, set_maximum_feedrate, (double), (override));
  MOCK_METHOD(Expected<>, set_spindle_maximum_torque, (int, double), (override));
  MOCK_METHOD(Expected<>, set_spindle_control_method, (int, ControlMethod), (override));
  MOCK_METHOD(Expected<>, set_spindle_servo_control_law, (int, const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_spindle_servo_control_gains, (int, std::span<const double>), (override));
  MOCK_METHOD(Expected<>, set_spindle_maximum_rpm, (int, double), (override));
  MOCK_METHOD(Expected<>, set_joint_control_method, (int, ControlMethod), (override));
  MOCK_METHOD(Expected<>, set_joint_servo_control_law, (int, const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_joint_servo_control_gains, (int, std::span<const double>), (override));
  MOCK_METHOD(Expected<>, set_joint_watch, (int, double, double), (override));
  MOCK_METHOD(Expected<>, set_joint_mechanics, (int, const JointMechanics&), (override));
  MOCK_METHOD(Expected<>, set_digital_control_interface, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, initialize_digital_control_interface, (), (override));
  MOCK_METHOD(Expected<>, set_digital_io_interface, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, initialize_digital_io_interface, (), (override));
  MOCK_METHOD(const sdk::DeviceObject&, draft, (), (const, override));
  MOCK_METHOD(Expected<>, apply, (), (override));
};

/// A device with two joints, a held one and a spindle.
inline sdk::DeviceObject two_joint_device() {
  sdk::DeviceObject device;
  device.name = "Fake";
  device.joints.resize(2);
  device.joints[0].limits = {"X", JointType::Linear, JointLimitType::Limited, -50, 50, 200, 1000, 10000};
  device.joints[1].limits = {"A", JointType::Rotary, JointLimitType::Infinite, -180, 180, 90, 500, 5000};
  device.joints[0].servo_law.name = "FakeLaw";
  device.held_joints.resize(1);
  device.held_joints[0].limits.max = 7;
  device.spindles.push_back({.bus = "sim0",
                             .axis = 3,
                             .max_speed_rpm = 1000,
                             .max_torque_nm = 5,
                             .horse_power = 2.5,
                             .speed_tolerance_rpm = 20,
                             .speed_timeout_s = 5});
  device.length_mm = device.width_mm = device.depth_mm = 100;
  return device;
}

class FakeDevice : public DevicePort {
 public:
  Expected<nlohmann::json> verify(const std::string& name) override {
    return nlohmann::json{{"mechanism", name}, {"ok", true}};
  }
  Expected<> ready_to_load(const std::string& /*name*/) override {
    if (during_preparation) during_preparation();
    if (!verification_refusal.empty()) return failure(MinorCode::InvalidParameterValue, verification_refusal);
    return {};
  }
  Expected<> load(const std::string& name, bool virtual_mode) override {
    if (during_load) during_load();
    if (name != "Fake") return failure(MinorCode::InvalidParameterValue, "no mechanism " + name + "; there is Fake");
    device = two_joint_device();
    is_virtual = virtual_mode;
    return {};
  }
  Expected<std::vector<ModuleInUse>> modules() const override {
    return std::vector<ModuleInUse>{{"kinematics", "FakeKinematics", "one"}};
  }
  Expected<> unload() override {
    if (!unload_refusal.empty()) return failure(MinorCode::Other, unload_refusal);
    device.reset();
    return {};
  }
  bool virtual_mode() const override { return is_virtual; }
  Expected<const sdk::DeviceObject*> database() const override {
    if (!device) return failure(MinorCode::UnsupportedOperation, "no mechanism is loaded; call Device.Load");
    return &*device;
  }
  Expected<sdk::DeviceObject*> wanted() override {
    if (!device) return failure(MinorCode::UnsupportedOperation, "no mechanism is loaded; call Device.Load");
    return &*device;
  }
  MOCK_METHOD(Expected<>, configure_motion_planner, (), (override));
  MOCK_METHOD(Expected<>, configure_servo_controller, (), (override));
  MOCK_METHOD(Expected<>, configure_digital_control_interface, (), (override));
  MOCK_METHOD(Expected<>, move, (std::int64_t, const Geometry&), (override));

  std::optional<sdk::DeviceObject> device = two_joint_device();
  bool is_virtual = false;
  std::string unload_refusal;        ///< why it cannot be taken out; empty: it can
  std::string verification_refusal;  ///< empty: what is loaded passes
  std::function<void()> during_preparation, during_load;
};

class MockTools : public ToolPort {
 public:
  MOCK_METHOD(Expected<std::vector<Tool>>, tools, (), (const, override));
  MOCK_METHOD(ToolsNow, tools_now, (), (const, override));
  MOCK_METHOD(Expected<>, set_tool, (const Tool&), (override));
  MOCK_METHOD(Expected<>, remove_tool, (int), (override));
  MOCK_METHOD(Expected<>, change_tool, (int), (override));
  MOCK_METHOD(Expected<>, confirm_tool, (int), (override));
};

class FakeMachine : public MachinePort {
 public:
  ToolPort& tools() override { return tools_mock; }
  sdk::RmacCam& cam() override { return cam_mock; }
  sdk::Measuring& measuring() override { return measuring_mock; }
  sdk::RmacConfig& config() override { return config_mock; }
  DevicePort& device() override { return device_fake; }
  const sdk::DeviceObject* mechanism() const override { return device_fake.device ? &*device_fake.device : nullptr; }
  CycleSample sample() const override { return now; }
  const CycleTimes& cycle_times() const override { return times; }
  CycleNow cycle_now() const override { return cycle; }
  const std::optional<Event>& last_stop() const override { return stop; }
  Expected<std::string> record_flight() override { return std::string("20261121T000000.000Z-demand-1"); }
  const FlightFolder* flight_records() const override { return nullptr; }
  Expected<ScanReport> rescan() override {
    return ScanReport{6, {{"mill/broken/device.json", "mill/broken/device.json: /Type is 5"}}};
  }

  testing::NiceMock<MockCam> cam_mock;
  testing::NiceMock<MockMeasuring> measuring_mock;
  testing::NiceMock<MockConfig> config_mock;
  testing::NiceMock<FakeDevice> device_fake;
  testing::NiceMock<MockTools> tools_mock;
  std::optional<Event> stop;
  CycleSample now;
  CycleTimes times;
  CycleNow cycle;
  std::function<void()> during_search;
};

/// Two records, A and B.
class FakeRecords : public RecordCursor {
 public:
  explicit FakeRecords(const FakeMachine* machine = nullptr) : machine_(machine) {}
  Expected<> open() override {
    rows_ = {row(1, "A"), row(2, "B")};
    at_ = 0;
    return {};
  }
  void close() override { rows_.clear(); }
  Expected<int> total() const override { return 2; }
  Expected<int> search(const std::string& sql) override {
    if (machine_ != nullptr && machine_->during_search) machine_->during_search();
    rows_ = {row(2, sql)};
    at_ = 0;
    return 1;
  }
  Expected<DriverRecord> current() const override {
    if (rows_.empty()) return failure(MinorCode::Other, "the record set is closed");
    return rows_[at_];
  }
  Expected<> first() override { return go(0); }
  Expected<> last() override { return go(rows_.size() - 1); }
  Expected<> next() override { return go(at_ + 1); }
  Expected<> previous() override { return go(at_ - 1); }

 private:
  static DriverRecord row(int id, const std::string& name) {
    DriverRecord record;
    record.mechanism_id = id;
    record.name = name;
    record.driver_version = "1.2.3";
    record.length = record.width = record.depth = 100.5;
    return record;
  }
  Expected<> go(std::size_t where) {
    if (where >= rows_.size()) return failure(MinorCode::Other, "no such row");
    at_ = where;
    return {};
  }
  const FakeMachine* machine_;
  std::vector<DriverRecord> rows_;
  std::size_t at_ = 0;
};

}  // namespace rmac::gateway::fakes
