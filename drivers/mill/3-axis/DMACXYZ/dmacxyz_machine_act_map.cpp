#include "rmac/modules/ball_screw_map.hpp"

RMAC_MODULE(ActuatorMap, "DMACXYZMachineActMap", rmac::ActuatorMap, rmac::modules::BallScrewMapFactory<3>)
