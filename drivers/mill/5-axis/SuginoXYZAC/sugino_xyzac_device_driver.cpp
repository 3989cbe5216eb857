#include "rmac/sdk/module.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

RMAC_MODULE(DeviceDriver, "SuginoXYZAC", rmac::sdk::DeviceDriver, rmac::sdk::StandardDeviceDriverFactory)
