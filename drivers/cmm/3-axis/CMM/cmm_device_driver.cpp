#include "rmac/sdk/module.hpp"
#include "rmac/sdk/standard_device_driver.hpp"

// The high-level driver of 5.2.3: it is blind to the machine that it measures on, which is configured and moved through
// the low-level one, the driver of that machine. This one configures where the CMM is loaded alone.
RMAC_MODULE(DeviceDriver, "CMM", rmac::sdk::DeviceDriver, rmac::sdk::StandardDeviceDriverFactory)
