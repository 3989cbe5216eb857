#include "rmac/modules/cartesian_kinematics.hpp"
#include "rmac/sdk/module.hpp"

namespace {

struct Factory {
  static rmac::Kinematics* create(rmac::sdk::Parameters /*parameters*/, char* /*error*/,
                                  std::size_t /*size*/) noexcept {
    return new rmac::modules::CartesianKinematics<3>();
  }
};

}  // namespace

RMAC_MODULE(Kinematics, "BenchXYZKinematics", rmac::Kinematics, Factory)
