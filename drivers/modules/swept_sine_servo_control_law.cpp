#include "rmac/modules/swept_sine_servo_law.hpp"

RMAC_MODULE(ServoLaw, "SweptSineServoControlLaw", rmac::ServoLaw, rmac::modules::SweptSineServoLawFactory)
