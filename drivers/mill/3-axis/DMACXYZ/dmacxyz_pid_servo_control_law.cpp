#include "rmac/modules/pid_servo_law.hpp"

RMAC_MODULE(ServoLaw, "DMACXYZPIDServoControlLaw", rmac::ServoLaw, rmac::modules::PidServoLawFactory)
