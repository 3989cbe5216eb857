#include "rmac/modules/fuzzy_servo_law.hpp"

RMAC_MODULE(ServoLaw, "FuzzyServoControlLaw", rmac::ServoLaw, rmac::modules::FuzzyServoLawFactory)
