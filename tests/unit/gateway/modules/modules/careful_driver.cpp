// A device driver that configures more than device.json says: its first joint at half the speed.
#include "rmac/sdk/standard_device_driver.hpp"

namespace {

class CarefulDriver final : public rmac::sdk::StandardDeviceDriver {
 public:
  rmac::Expected<> configure_motion_planner(const rmac::sdk::DeviceObject& device,
                                            rmac::sdk::RmacConfig& config) override {
    return StandardDeviceDriver::configure_motion_planner(device, config).and_then([&] {
      return config.joints().set_maximum_speed(0, device.joints[0].limits.max_speed / 2);
    });
  }
};

struct Factory {
  static rmac::sdk::DeviceDriver* create(rmac::sdk::Parameters, char*, std::size_t) noexcept {
    return new CarefulDriver();
  }
};

}  // namespace

RMAC_MODULE(DeviceDriver, "CarefulDriver", rmac::sdk::DeviceDriver, Factory)
