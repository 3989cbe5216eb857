#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/vector.hpp"
#include "rmac/sdk/parameters.hpp"

namespace {

using namespace rmac;

/// How far arms and hub stay from where the machine is singular, as parts of an arm's length.
constexpr double kMargin = 0.05;
constexpr std::size_t kTowers = 3;

/// Three carriages on upright rails, a third of a turn apart, and from each an arm of the same length down to the hub,
/// which pairs of rods keep upright. With all carriages at zero the hub is at the origin.
class LinearDelta final : public Kinematics {
 public:
  LinearDelta(double radius_mm, double arm_mm)
      : arm_(arm_mm), above_(std::sqrt(arm_mm * arm_mm - radius_mm * radius_mm)) {
    for (std::size_t i = 0; i < kTowers; ++i) {
      const double angle = std::numbers::pi * (0.5 + 2.0 / 3 * static_cast<double>(i));
      towers_[i] = {radius_mm * std::cos(angle), radius_mm * std::sin(angle), above_};
    }
  }

  std::size_t joint_count() const noexcept override { return kTowers; }
  JointType joint_type(std::size_t) const noexcept override { return JointType::Linear; }
  bool parallel() const noexcept override { return true; }

  bool has_pose(std::span<const double> joints) const noexcept override { return hub(joints).has_value(); }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    if (const auto at = hub(joints)) pose = {along(*at, 1, tool.p), z_axis(tool)};
  }

  KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> /*seed*/,
                           std::span<double> joints) const noexcept override {
    constexpr double kUpright = 1e-9;
    if (!(distance(pose.axis, z_axis(tool)) <= kUpright)) return KinematicsStatus::OutOfReach;
    const Vector wanted = difference(pose.tip, tool.p);
    for (std::size_t i = 0; i < kTowers; ++i) {
      const Vector way = difference(wanted, towers_[i]);
      const double drop = arm_ * arm_ - way[0] * way[0] - way[1] * way[1];
      if (!(drop > 0)) return KinematicsStatus::OutOfReach;
      joints[i] = way[2] + std::sqrt(drop);
    }
    // These carriages may hold the hub above themselves as well as below: only one of the two is the machine.
    const auto at = hub(joints);
    constexpr double kSame_mm = 1e-6;
    return at && distance(*at, wanted) <= kSame_mm ? KinematicsStatus::Ok : KinematicsStatus::OutOfReach;
  }

  /// An arm keeps its length: its direction · (speed of the hub - speed of the carriage) = 0, for each of the three.
  void jacobian(std::span<const double> joints, const Frame&, std::span<double> jacobian) const noexcept override {
    for (double& entry : jacobian) entry = 0;
    const auto at = hub(joints);
    if (!at) return;
    std::array<Vector, kTowers> arm;
    for (std::size_t i = 0; i < kTowers; ++i) arm[i] = difference(*at, carriage(joints, i));
    const double volume = dot(arm[0], cross(arm[1], arm[2]));
    for (std::size_t i = 0; i < kTowers; ++i) {
      const Vector across = cross(arm[(i + 1) % kTowers], arm[(i + 2) % kTowers]);
      for (std::size_t row = 0; row < 3; ++row) jacobian[row * kTowers + i] = across[row] * arm[i][2] / volume;
    }
  }

 private:
  Vector carriage(std::span<const double> joints, std::size_t i) const noexcept {
    return along(towers_[i], joints[i], {0, 0, 1});
  }

  /// Where three spheres about the carriages meet below them, if they do: below the middle of the circle through the
  /// carriages, at right angles to its plane.
  std::optional<Vector> hub(std::span<const double> joints) const noexcept {
    const Vector first = carriage(joints, 0);
    const Vector a = difference(carriage(joints, 1), first), b = difference(carriage(joints, 2), first);
    const Vector up = cross(a, b);  // the towers stand counter-clockwise
    const double area2 = dot(up, up);
    const Vector chords = along(scaled(dot(b, b), a), -dot(a, a), b);
    const Vector to_middle = scaled(-0.5 / area2, cross(chords, up));
    const double least = kMargin * arm_, below2 = arm_ * arm_ - dot(to_middle, to_middle);
    if (!(below2 >= least * least)) return std::nullopt;  // the arms do not meet, or nearly lie in the plane
    const Vector at = along(along(first, 1, to_middle), -std::sqrt(below2 / area2), up);
    for (std::size_t i = 0; i < kTowers; ++i) {
      if (!(carriage(joints, i)[2] - at[2] >= least)) return std::nullopt;  // an arm stands up
    }
    return at;
  }

  double arm_, above_;
  std::array<Vector, kTowers> towers_{};
};

struct Factory {
  static Kinematics* create(sdk::Parameters parameters, char* error, std::size_t size) noexcept {
    const sdk::NumberParameter radius_mm{"radius", 120, 10, 1000, "mm"};
    double radius = 0, arm = 0;
    if (!sdk::read_number(parameters, radius_mm, radius, error, size)) return nullptr;
    const sdk::NumberParameter arm_mm{"arm", 250, 1.2 * radius, 5000, "mm"};
    if (!sdk::read_number(parameters, arm_mm, arm, error, size)) return nullptr;
    return new LinearDelta(radius, arm);
  }
};

}  // namespace

RMAC_MODULE(Kinematics, "LinearDeltaKinematics", rmac::Kinematics, Factory)
