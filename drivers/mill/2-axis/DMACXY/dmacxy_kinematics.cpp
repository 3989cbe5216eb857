#include "rmac/modules/chain_kinematics_factory.hpp"

namespace {
using Factory = rmac::modules::ChainKinematicsFactory<'X', 'Y'>;
}

RMAC_MODULE(Kinematics, "DMACXYKinematics", rmac::Kinematics, Factory)
