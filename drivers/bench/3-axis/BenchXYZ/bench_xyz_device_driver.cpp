#include "rmac/sdk/module.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

namespace {

struct Factory {
  static rmac::sdk::DeviceDriver* create(rmac::sdk::Parameters /*parameters*/, char* /*error*/,
                                         std::size_t /*size*/) noexcept {
    return new rmac::sdk::StandardDeviceDriver();
  }
};

}  // namespace

RMAC_MODULE(DeviceDriver, "BenchXYZ", rmac::sdk::DeviceDriver, Factory)
