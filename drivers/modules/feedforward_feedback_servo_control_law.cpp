#include "rmac/modules/feedforward_feedback_servo_law.hpp"

RMAC_MODULE(ServoLaw, "FeedforwardFeedbackServoControlLaw", rmac::ServoLaw,
            rmac::modules::FeedforwardFeedbackServoLawFactory)
