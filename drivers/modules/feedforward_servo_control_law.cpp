#include "rmac/modules/feedforward_servo_law.hpp"

RMAC_MODULE(ServoLaw, "FeedforwardServoControlLaw", rmac::ServoLaw, rmac::modules::FeedforwardServoLawFactory)
