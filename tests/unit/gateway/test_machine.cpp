#include "test_machine.hpp"

#include <algorithm>
#include <cmath>

#include "gateway/buses/simulated_bus.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

namespace rmac::gateway {
namespace {

/// A bus that answers to nobody.
class DeadBus final : public fieldbus::SimulatedInterface {
 public:
  explicit DeadBus(std::string trouble)
      : SimulatedInterface(fieldbus::default_simulated_axes(), 0.001), trouble_(std::move(trouble)) {}
  Expected<> start() override { return failure(MinorCode::CommTimeout, trouble_); }

 private:
  std::string trouble_;
};

}  // namespace

ControllerOptions TestMachine::with_interfaces(ControllerOptions controller_options) {
  controller_options.control_interfaces["TestBus"] =
      [this](const std::string&, const sdk::ModuleChoice& choice,
             const ModuleLoader&) -> Expected<std::shared_ptr<DigitalControlInterface>> {
    if (!bus_trouble.empty()) return std::make_shared<DeadBus>(bus_trouble);
    if (!bus || bus.use_count() == 1) {
      const auto axes = simulated_axes(choice);
      if (!axes) return tl::unexpected(axes.error());
      bus = std::make_shared<fieldbus::SimulatedInterface>(*axes, 0.001);
    }
    return bus;
  };
  controller_options.io_interfaces["TestIo"] =
      [this](const sdk::ModuleChoice&, const ModuleLoader&) -> Expected<std::shared_ptr<DigitalIoInterface>> {
    if (!io) io = std::make_shared<fieldbus::SimulatedIoInterface>();
    return io;
  };
  return controller_options;
}

Expected<> TestMachine::draft(const sdk::DeviceObject& device) {
  sdk::StandardDeviceDriver driver;
  sdk::RmacConfig& config = controller.config();
  return config.begin(device)
      .and_then([&] { return driver.configure_motion_planner(device, config); })
      .and_then([&] { return driver.configure_servo_controller(device, config); })
      .and_then([&] { return driver.configure_digital_control_interface(device, config); });
}

Expected<> TestMachine::load_at_zero(const sdk::DeviceObject& device) {
  auto ready = load(device).and_then([&] { return controller.cam().positioning().home(); });
  if (!ready) return ready;
  const auto at_zero = [&] {
    const CycleSample now = controller.sample();
    const bool there = std::all_of(now.position_set.begin(), now.position_set.begin() + now.joint_count,
                                   [](double position) { return std::abs(position) < 1e-9; });
    return there && !now.moving && now.state == CycleState::Idle;
  };
  if (!run_until(at_zero)) return failure(MinorCode::Other, "the machine did not get home");
  controller.dispatch();
  events.clear();
  samples.clear();
  return {};
}

}  // namespace rmac::gateway
