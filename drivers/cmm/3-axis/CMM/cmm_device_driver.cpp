#include "rmac/sdk/module.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

// The high-level driver of 5.2.3: it is blind to the machine that it measures on. What it configures is the device
// object that it is handed, that of the mechanism which is loaded, in the role of a measuring machine.
RMAC_MODULE(DeviceDriver, "CMM", rmac::sdk::DeviceDriver, rmac::sdk::StandardDeviceDriverFactory)
