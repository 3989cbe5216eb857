#include "rmac/modules/feedforward_feedback_servo_law.hpp"

RMAC_MODULE(ServoLaw, "TarusXYZCAPFFServoControlLaw", rmac::ServoLaw, rmac::modules::FeedforwardFeedbackServoLawFactory)
