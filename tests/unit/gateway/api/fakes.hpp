#pragma once

#include <gmock/gmock.h>

#include "gateway/api/ports.hpp"

// Fakes of the API's ports. MockCam and MockConfig check calls; FakeDevice and FakeMachine keep values.

namespace rmac::gateway::fakes {

class MockCycle : public sdk::CycleControl {
 public:
  MOCK_METHOD(Expected<>, start, (sdk::CycleMode), (override));
  MOCK_METHOD(Expected<>, stop, (), (override));
  MOCK_METHOD(Expected<>, hold, (), (override));
  MOCK_METHOD(Expected<>, resume, (), (override));
  MOCK_METHOD(Expected<double>, retrace, (double), (override));
  MOCK_METHOD(Expected<>, stop_now, (), (override));
  MOCK_METHOD(Expected<>, reset, (), (override));
  MOCK_METHOD(bool, started, (), (const, override));
  MOCK_METHOD(Expected<>, set_feed_override, (double), (override));
};

class MockOperating : public OperatorPort {
 public:
  MOCK_METHOD(Expected<>, hold, (const OperatorRef&), (override));
  MOCK_METHOD(Expected<>, resume, (const OperatorRef&), (override));
  MOCK_METHOD(Expected<double>, retrace, (double, const OperatorRef&), (override));
  MOCK_METHOD(Expected<>, set_feed_override, (double, const OperatorRef&), (override));
  MOCK_METHOD(void, let_go, (), (override));
};

class MockQueue : public sdk::MoveQueue {
 public:
  MOCK_METHOD(Expected<>, add, (std::int64_t, const Geometry&), (override));
  MOCK_METHOD(int, moves_left, (), (const, override));
  MOCK_METHOD(Expected<std::vector<double>>, joints_at, (const ToolPose&), (const, override));
};

class MockCmmMoves : public sdk::CmmMoves {
 public:
  MOCK_METHOD(Expected<>, to_point, (std::int64_t, const Vector&, double), (override));
  MOCK_METHOD(Expected<>, in_arc, (std::int64_t, const sdk::ArcTo&, double), (override));
  MOCK_METHOD(Expected<>, all_joints, (std::int64_t, std::vector<double>, double), (override));
  MOCK_METHOD(Expected<>, rotary_joint, (std::int64_t, int, double, int, double), (override));
};

class MockPath : public sdk::PathSettings {
 public:
  MOCK_METHOD(Expected<>, set_feedrate, (double), (override));
  MOCK_METHOD(double, feedrate, (), (const, override));
  MOCK_METHOD(Expected<>, set_max_feedrate, (double), (override));
  MOCK_METHOD(double, max_feedrate, (), (const, override));
  MOCK_METHOD(Expected<>, set_accel_rise, (double), (override));
  MOCK_METHOD(double, accel_rise, (), (const, override));
  MOCK_METHOD(Expected<>, set_accel_fall, (double), (override));
  MOCK_METHOD(double, accel_fall, (), (const, override));
  MOCK_METHOD(Expected<>, set_tolerance, (double), (override));
  MOCK_METHOD(double, tolerance, (), (const, override));
  MOCK_METHOD(Expected<>, set_orientation_tolerance, (double), (override));
  MOCK_METHOD(double, orientation_tolerance, (), (const, override));
};

class MockJoints : public sdk::JointSettings {
 public:
  MOCK_METHOD(Expected<>, set_interp_speed, (double), (override));
  MOCK_METHOD(double, interp_speed, (), (const, override));
  MOCK_METHOD(Expected<>, set_accel_rise, (int, double), (override));
  MOCK_METHOD(Expected<double>, accel_rise, (int), (const, override));
  MOCK_METHOD(Expected<>, set_accel_fall, (int, double), (override));
  MOCK_METHOD(Expected<double>, accel_fall, (int), (const, override));
};

class MockFrames : public sdk::FrameSettings {
 public:
  MOCK_METHOD(Expected<>, set_part, (const Frame&), (override));
  MOCK_METHOD(Frame, part, (), (const, override));
  MOCK_METHOD(Expected<>, set_tool_interface, (const Frame&), (override));
  MOCK_METHOD(Frame, tool_interface, (), (const, override));
};

class MockSpindles : public sdk::SpindleControl {
 public:
  MOCK_METHOD(Expected<>, set_rpm, (int, double), (override));
  MOCK_METHOD(Expected<double>, rpm, (int), (const, override));
  MOCK_METHOD(Expected<>, set_max_rpm, (int, double), (override));
  MOCK_METHOD(Expected<double>, max_rpm, (int), (const, override));
  MOCK_METHOD(Expected<>, set_coolant, (bool), (override));
  MOCK_METHOD(Expected<>, set_output, (const std::string&, bool), (override));
};

class MockPositioning : public sdk::Positioning {
 public:
  MOCK_METHOD(Expected<>, jog_joint, (int, double), (override));
  MOCK_METHOD(Expected<>, jog_joint_at, (int, double), (override));
  MOCK_METHOD(Expected<>, jog_path, (const sdk::JogDirection&, double), (override));
  MOCK_METHOD(Expected<>, jog_path_at, (const sdk::JogDirection&, double), (override));
  MOCK_METHOD(Expected<>, home, (), (override));
  MOCK_METHOD(Expected<>, move_to_reference_point, (), (override));
  MOCK_METHOD(Expected<std::vector<double>>, current_position, (), (const, override));
};

class MockParking : public sdk::Parking {
 public:
  MOCK_METHOD(Expected<>, park, (), (override));
  MOCK_METHOD(Expected<>, take_up, (), (override));
  MOCK_METHOD(Expected<>, drop, (), (override));
  MOCK_METHOD(std::optional<sdk::ParkedProgram>, parked, (), (const, override));
};

class MockForces : public sdk::JointForces {
 public:
  MOCK_METHOD(Expected<>, set, (int, double), (override));
};

class MockFlow : public sdk::ProgramFlow {
 public:
  MOCK_METHOD(Expected<>, dwell, (std::int64_t, double), (override));
  MOCK_METHOD(Expected<>, stop, (std::int64_t, bool, const std::string&), (override));
  MOCK_METHOD(Expected<>, await_input, (std::int64_t, const std::string&, bool, double), (override));
  MOCK_METHOD(Expected<>, in_turn, (std::int64_t, const std::vector<sdk::CallInTurn>&), (override));
  MOCK_METHOD(void, set_optional_stops, (bool), (override));
  MOCK_METHOD(bool, optional_stops, (), (const, override));
};

class MockCam : public sdk::RmacCam {
 public:
  sdk::CycleControl& cycle() override { return cycle_mock; }
  sdk::MoveQueue& queue() override { return queue_mock; }
  sdk::CmmMoves& cmm_moves() override { return cmm_moves_mock; }
  sdk::PathSettings& path() override { return path_mock; }
  sdk::JointSettings& joints() override { return joints_mock; }
  sdk::FrameSettings& frames() override { return frames_mock; }
  sdk::SpindleControl& spindles() override { return spindles_mock; }
  sdk::Positioning& positioning() override { return positioning_mock; }
  sdk::Parking& parking() override { return parking_mock; }
  sdk::JointForces& forces() override { return forces_mock; }
  sdk::ProgramFlow& flow() override { return flow_mock; }

  testing::NiceMock<MockCycle> cycle_mock;
  testing::NiceMock<MockQueue> queue_mock;
  testing::NiceMock<MockCmmMoves> cmm_moves_mock;
  testing::NiceMock<MockPath> path_mock;
  testing::NiceMock<MockJoints> joints_mock;
  testing::NiceMock<MockFrames> frames_mock;
  testing::NiceMock<MockSpindles> spindles_mock;
  testing::NiceMock<MockPositioning> positioning_mock;
  testing::NiceMock<MockParking> parking_mock;
  testing::NiceMock<MockForces> forces_mock;
  testing::NiceMock<MockFlow> flow_mock;
};

class MockMeasuring : public sdk::Measuring {
 public:
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

class MockMechanismConfig : public sdk::MechanismConfig {
 public:
  MOCK_METHOD(Expected<>, set_kinematics, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_actuator_map, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_number_of_joints, (int), (override));
  MOCK_METHOD(Expected<>, set_number_of_spindles, (int), (override));
  MOCK_METHOD(Expected<>, set_number_of_actuators, (int), (override));
  MOCK_METHOD(Expected<>, set_actuators, (std::span<const sdk::Actuator>), (override));
  MOCK_METHOD(Expected<>, set_spindles, (std::span<const sdk::Spindle>), (override));
  MOCK_METHOD(Expected<>, set_maximum_feedrate, (double), (override));
};

class MockJointConfig : public sdk::JointConfig {
 public:
  MOCK_METHOD(Expected<>, set_name, (int, std::string_view), (override));
  MOCK_METHOD(Expected<>, set_type, (int, JointType), (override));
  MOCK_METHOD(Expected<>, set_limit_type, (int, JointLimitType), (override));
  MOCK_METHOD(Expected<>, set_maximum_limit, (int, double), (override));
  MOCK_METHOD(Expected<>, set_minimum_limit, (int, double), (override));
  MOCK_METHOD(Expected<>, set_maximum_speed, (int, double), (override));
  MOCK_METHOD(Expected<>, set_maximum_acceleration, (int, double), (override));
  MOCK_METHOD(Expected<>, set_maximum_jerk, (int, double), (override));
};

class MockLoopConfig : public sdk::LoopConfig {
 public:
  MOCK_METHOD(Expected<>, set_control_method, (int, ControlMethod), (override));
  MOCK_METHOD(Expected<>, set_servo_law, (int, const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_gains, (int, std::span<const double>), (override));
  MOCK_METHOD(Expected<>, set_watch, (int, double, double), (override));
  MOCK_METHOD(Expected<>, set_mechanics, (int, const JointMechanics&), (override));
};

class MockSpindleConfig : public sdk::SpindleConfig {
 public:
  MOCK_METHOD(Expected<>, set_maximum_rpm, (int, double), (override));
  MOCK_METHOD(Expected<>, set_maximum_torque, (int, double), (override));
  MOCK_METHOD(Expected<>, set_control_method, (int, ControlMethod), (override));
  MOCK_METHOD(Expected<>, set_servo_law, (int, const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, set_gains, (int, std::span<const double>), (override));
};

class MockInterfaceConfig : public sdk::InterfaceConfig {
 public:
  MOCK_METHOD(Expected<>, set_control, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, initialize_control, (), (override));
  MOCK_METHOD(Expected<>, set_io, (const sdk::ModuleChoice&), (override));
  MOCK_METHOD(Expected<>, initialize_io, (), (override));
};

class MockConfig : public sdk::RmacConfig {
 public:
  sdk::MechanismConfig& mechanism() override { return mechanism_mock; }
  sdk::JointConfig& joints() override { return joints_mock; }
  sdk::LoopConfig& loops() override { return loops_mock; }
  sdk::SpindleConfig& spindles() override { return spindles_mock; }
  sdk::InterfaceConfig& interfaces() override { return interfaces_mock; }
  MOCK_METHOD(Expected<>, begin, (const sdk::DeviceObject&), (override));
  MOCK_METHOD(const sdk::DeviceObject&, draft, (), (const, override));
  MOCK_METHOD(Expected<>, apply, (), (override));

  testing::NiceMock<MockMechanismConfig> mechanism_mock;
  testing::NiceMock<MockJointConfig> joints_mock;
  testing::NiceMock<MockLoopConfig> loops_mock;
  testing::NiceMock<MockSpindleConfig> spindles_mock;
  testing::NiceMock<MockInterfaceConfig> interfaces_mock;
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
    if (during_verification) during_verification();
    return nlohmann::json{{"mechanism", name}, {"ok", true}};
  }
  Job loading(const std::string& /*name*/, double /*soften*/) override {
    return [this]() -> Expected<> {
      if (during_preparation) during_preparation();
      if (!verification_refusal.empty()) return failure(MinorCode::InvalidParameterValue, verification_refusal);
      return {};
    };
  }
  Job applying() override { return {}; }
  Job configuring() override { return {}; }
  Expected<> load(const std::string& name, bool virtual_mode, double /*soften*/) override {
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
  std::function<void()> during_verification, during_preparation, during_load;
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

class MockGuard : public GuardPort {
 public:
  MOCK_METHOD(Expected<>, set_setup, (const nlohmann::json&), (override));
  MOCK_METHOD(nlohmann::json, setup, (), (const, override));
  MOCK_METHOD(Expected<>, set_check, (bool), (override));
  MOCK_METHOD(bool, checks, (), (const, override));
};

class MockLearning : public LearningPort {
 public:
  MOCK_METHOD(Expected<>, set_learned, (const nlohmann::json&), (override));
  MOCK_METHOD(Expected<nlohmann::json>, learned, (), (const, override));
  MOCK_METHOD(void, forget, (), (override));
};

/// A machine whose links are not known, unless a test says what can be drawn.
class FakeShape : public ShapePort {
 public:
  void set_bodies(MachineBodies /*bodies*/) override {}
  std::shared_ptr<const MachineDrawing> drawing() const override { return now; }

  std::shared_ptr<const MachineDrawing> now = std::make_shared<const MachineDrawing>();
};

class FakeMachine : public MachinePort {
 public:
  // Not here: every file that includes this would compile all mocks anew.
  FakeMachine();
  FakeMachine(const FakeMachine&) = delete;
  FakeMachine& operator=(const FakeMachine&) = delete;
  ~FakeMachine() override;

  ToolPort& tools() override { return tools_mock; }
  GuardPort& guard() override { return guard_mock; }
  LearningPort& learning() override { return learning_mock; }
  ShapePort& shape() override { return shape_fake; }
  sdk::RmacCam& cam() override { return cam_mock; }
  OperatorPort& operating() override { return operating_mock; }
  sdk::Measuring& measuring() override { return measuring_mock; }
  sdk::RmacConfig& config() override { return config_mock; }
  DevicePort& device() override { return device_fake; }
  const sdk::DeviceObject* mechanism() const override { return device_fake.device ? &*device_fake.device : nullptr; }
  CycleSample sample() const override { return now; }
  const CycleTimes& cycle_times() const override { return times; }
  CycleNow cycle_now() const override { return cycle; }
  fieldbus::FieldbusReport bus_reports() const override { return buses; }
  const nlohmann::json& bus_summary() const override { return bus_summary_told; }
  const std::optional<Event>& last_stop() const override { return stop; }
  Expected<std::string> record_flight() override { return std::string("20261121T000000.000Z-demand-1"); }
  const FlightFolder* flight_records() const override { return nullptr; }
  Expected<ScanReport> rescan() override {
    return ScanReport{6, {{"mill/broken/device.json", "mill/broken/device.json: /Type is 5"}}};
  }

  testing::NiceMock<MockCam> cam_mock;
  testing::NiceMock<MockOperating> operating_mock;
  testing::NiceMock<MockMeasuring> measuring_mock;
  testing::NiceMock<MockConfig> config_mock;
  testing::NiceMock<FakeDevice> device_fake;
  testing::NiceMock<MockTools> tools_mock;
  testing::NiceMock<MockGuard> guard_mock;
  testing::NiceMock<MockLearning> learning_mock;
  FakeShape shape_fake;
  std::optional<Event> stop;
  CycleSample now;
  CycleTimes times;
  fieldbus::FieldbusReport buses;
  nlohmann::json bus_summary_told = nlohmann::json::array();
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
