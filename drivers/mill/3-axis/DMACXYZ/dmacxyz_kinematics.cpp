#include "rmac/modules/chain_kinematics_factory.hpp"

namespace {
using Factory = rmac::modules::ChainKinematicsFactory<'X', 'Y', 'Z'>;
}

RMAC_MODULE(Kinematics, "DMACXYZKinematics", rmac::Kinematics, Factory)
