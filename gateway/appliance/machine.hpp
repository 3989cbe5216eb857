#pragma once

#include <memory>
#include <utility>

#include "gateway/api/ports.hpp"
#include "gateway/controller/controller.hpp"
#include "gateway/device_driver/device_host.hpp"
#include "gateway/device_driver_manager/device_driver_manager.hpp"

// The API's ports, bound to the real machine: nothing here but passing on.

namespace rmac::gateway {

class Records final : public RecordCursor {
 public:
  explicit Records(const DeviceDriverManager& manager) : set_(manager) {}
  Expected<> open() override { return set_.open(); }
  void close() override { set_.close(); }
  Expected<int> total() const override { return set_.total(); }
  Expected<int> search(const std::string& sql) override { return set_.search(sql); }
  Expected<DriverRecord> current() const override { return set_.current(); }
  Expected<> first() override { return set_.first(); }
  Expected<> last() override { return set_.last(); }
  Expected<> next() override { return set_.next(); }
  Expected<> previous() override { return set_.previous(); }

 private:
  DriverRecordSet set_;
};

class HostedDevice final : public DevicePort {
 public:
  explicit HostedDevice(DeviceHost& host) : host_(host) {}
  Expected<nlohmann::json> verify(const std::string& name) override {
    return host_.verify(name).map([](const verifier::Report& report) { return verifier::to_json(report); });
  }
  Job loading(const std::string& name, double soften) override {
    return [this, name, soften] { return host_.ready_to_load(name, soften); };
  }
  Job applying() override { return host_.verification_of_draft(); }
  Job configuring() override { return host_.verification_of_wanted(); }
  Expected<> load(const std::string& name, bool virtual_mode, double soften) override {
    return host_.load(name, virtual_mode, soften);
  }
  Expected<> unload() override { return host_.unload(); }
  Expected<std::vector<ModuleInUse>> modules() const override { return host_.modules(); }
  bool virtual_mode() const override { return host_.virtual_mode(); }
  Expected<const sdk::DeviceObject*> database() const override { return host_.database(); }
  Expected<sdk::DeviceObject*> wanted() override { return host_.wanted(); }
  Expected<> configure_motion_planner() override { return host_.configure_motion_planner(); }
  Expected<> configure_servo_controller() override { return host_.configure_servo_controller(); }
  Expected<> configure_digital_control_interface() override { return host_.configure_digital_control_interface(); }
  Expected<> move(std::int64_t id, const Geometry& geometry) override { return host_.move(id, geometry); }

 private:
  DeviceHost& host_;
};

class Machine final : public MachinePort {
 public:
  Machine(Controller& controller, DeviceHost& host, DeviceDriverManager& manager)
      : controller_(controller), manager_(manager), device_(host) {}
  sdk::RmacCam& cam() override { return controller_.cam(); }
  OperatorPort& operating() override { return controller_.operating(); }
  sdk::Measuring& measuring() override { return controller_.measuring(); }
  sdk::RmacConfig& config() override { return controller_.config(); }
  DevicePort& device() override { return device_; }
  ToolPort& tools() override { return controller_.tools(); }
  GuardPort& guard() override { return collision_guard(controller_); }
  LearningPort& learning() override { return learning_of(controller_); }
  ShapePort& shape() override { return machine_shape(controller_); }
  const sdk::DeviceObject* mechanism() const override { return controller_.mechanism(); }
  CycleSample sample() const override { return controller_.sample(); }
  const CycleTimes& cycle_times() const override { return controller_.cycle_times(); }
  fieldbus::FieldbusReport bus_reports() const override { return gateway::bus_reports(controller_); }
  const nlohmann::json& bus_summary() const override { return gateway::bus_summary(controller_); }
  CycleNow cycle_now() const override { return controller_.cycle_now(); }
  const std::optional<Event>& last_stop() const override { return controller_.last_stop(); }
  Expected<std::string> record_flight() override { return controller_.record_flight(); }
  const FlightFolder* flight_records() const override { return controller_.flight_records(); }
  Expected<ScanReport> rescan() override {
    return manager_.rescan().map([&](int mechanisms) { return ScanReport{mechanisms, manager_.problems()}; });
  }

 private:
  Controller& controller_;
  DeviceDriverManager& manager_;
  HostedDevice device_;
};

}  // namespace rmac::gateway
