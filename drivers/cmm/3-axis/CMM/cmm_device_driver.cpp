#include "rmac/sdk/module.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

namespace {

using rmac::Expected;

/// Says what is missing: a measuring machine that moves and cannot measure would only look like one.
class CmmDeviceDriver final : public rmac::sdk::StandardDeviceDriver {
 public:
  Expected<> configure_motion_planner(const rmac::sdk::DeviceObject& /*device*/,
                                      rmac::sdk::RmacConfig& /*config*/) override {
    return rmac::failure(rmac::MinorCode::UnsupportedOperation,
                         "CMM can be searched and shown, not loaded: the controller has no measuring functions yet "
                         "(AutoMeasure, ManualMeasure and the like); to move its axes load SuginoXYZ, whose they are");
  }
};

struct Factory {
  static rmac::sdk::DeviceDriver* create(rmac::sdk::Parameters /*parameters*/, char* /*error*/,
                                         std::size_t /*size*/) noexcept {
    return new CmmDeviceDriver();
  }
};

}  // namespace

RMAC_MODULE(DeviceDriver, "CMM", rmac::sdk::DeviceDriver, Factory)
