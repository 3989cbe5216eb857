#include "rmac/modules/pid_servo_law.hpp"

RMAC_MODULE(ServoLaw, "PIDServoControlLaw", rmac::ServoLaw, rmac::modules::PidServoLawFactory)
