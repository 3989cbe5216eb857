#include "rmac/sdk/standard_device_driver.hpp"

#include "rmac/sdk/module.hpp"

RMAC_MODULE(DeviceDriver, "StandardDeviceDriver", rmac::sdk::DeviceDriver, rmac::sdk::StandardDeviceDriverFactory)
