#include <algorithm>

#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/sdk/module.hpp"

#define TEST_TEXT_OF(x) #x
#define TEST_TEXT(x) TEST_TEXT_OF(x)
#ifndef TEST_NAME
#define TEST_NAME "TestKinematics" TEST_TEXT(TEST_JOINTS)
#endif

namespace {

/// What an inline function keeps would be one object for all copies of the module, were it not built with
/// -fno-gnu-unique: then a rebuilt module would see the old one's value.
inline double& kept_shift_mm() {
  static double shift = TEST_SHIFT_MM;
  return shift;
}

/// Joints are x, y and z; with two of them z stays zero. A shift tells one build from another.
class Cartesian final : public rmac::Kinematics {
 public:
  std::size_t joint_count() const noexcept override { return TEST_JOINTS; }
  rmac::JointType joint_type(std::size_t) const noexcept override { return rmac::JointType::Linear; }
  void forward(std::span<const double> joints, const rmac::Frame& tool, rmac::ToolPose& pose) const noexcept override {
    pose = {};
    for (std::size_t i = 0; i < TEST_JOINTS; ++i) pose.tip[i] = joints[i] + tool.p[i];
    pose.tip[0] += kept_shift_mm();
  }
  rmac::KinematicsStatus inverse(const rmac::ToolPose& pose, const rmac::Frame& tool, std::span<const double>,
                                 std::span<double> joints) const noexcept override {
    for (std::size_t i = 0; i < TEST_JOINTS; ++i) joints[i] = pose.tip[i] - tool.p[i];
    joints[0] -= kept_shift_mm();
    const bool on_plane = TEST_JOINTS == 3 || (pose.tip[2] < 1e-6 && pose.tip[2] > -1e-6);
    return on_plane ? rmac::KinematicsStatus::Ok : rmac::KinematicsStatus::OutOfReach;
  }
  void jacobian(std::span<const double>, const rmac::Frame&, std::span<double> jacobian) const noexcept override {
    std::fill(jacobian.begin(), jacobian.end(), 0.0);
    for (std::size_t i = 0; i < TEST_JOINTS; ++i) jacobian[i * TEST_JOINTS + i] = 1;
  }
};

struct Factory {
  static rmac::Kinematics* create(rmac::sdk::Parameters, char*, std::size_t) { return new Cartesian; }
};

}  // namespace

RMAC_MODULE(Kinematics, TEST_NAME, rmac::Kinematics, Factory)
