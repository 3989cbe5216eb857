#include "rmac/modules/chain_kinematics_factory.hpp"

RMAC_MODULE(Kinematics, "ChainKinematics", rmac::Kinematics, rmac::modules::ChainKinematicsFactory<>)
