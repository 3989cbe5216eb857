#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/sdk/parameters.hpp"

namespace {

using namespace rmac;

constexpr double kRad = std::numbers::pi / 180;
constexpr std::size_t kJoints = 3;

/// A shoulder and an elbow that turn about upright axes, and a quill that carries the tool up and down.
class TableScara final : public Kinematics {
 public:
  TableScara(double upper_arm_mm, double forearm_mm) : upper_arm_(upper_arm_mm), forearm_(forearm_mm) {}

  std::size_t joint_count() const noexcept override { return kJoints; }
  JointType joint_type(std::size_t joint) const noexcept override {
    return joint == 2 ? JointType::Linear : JointType::Rotary;
  }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    const double shoulder = joints[0] * kRad, hand = shoulder + joints[1] * kRad;
    const double c = std::cos(hand), s = std::sin(hand), reach = forearm_ + tool.p[0];
    pose.tip = {upper_arm_ * std::cos(shoulder) + c * reach - s * tool.p[1],
                upper_arm_ * std::sin(shoulder) + s * reach + c * tool.p[1], joints[2] + tool.p[2]};
    const Vector axis = z_axis(tool);
    pose.axis = {c * axis[0] - s * axis[1], s * axis[0] + c * axis[1], axis[2]};
  }

  KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                           std::span<double> joints) const noexcept override {
    std::array<double, 2 * kJoints> all{};
    if (solutions(pose, tool, seed, all) == 0) return KinematicsStatus::OutOfReach;
    for (std::size_t j = 0; j < kJoints; ++j) joints[j] = all[j];
    return KinematicsStatus::Ok;
  }

  /// Elbow to the left and elbow to the right. With the tool, the forearm is as long as from elbow to tip.
  std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                        std::span<double> joints) const noexcept override {
    const double along = forearm_ + tool.p[0], across = tool.p[1];
    const double lower = std::hypot(along, across), bend = std::atan2(across, along);
    const double x = pose.tip[0], y = pose.tip[1];
    const double cosine = (x * x + y * y - upper_arm_ * upper_arm_ - lower * lower) / (2 * upper_arm_ * lower);
    constexpr double kRounding = 1e-12;
    if (!(std::abs(cosine) <= 1 + kRounding) || !std::isfinite(pose.tip[2])) return 0;
    const double sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
    std::array<std::array<double, kJoints>, 2> found{};
    std::array<double, 2> way{};
    std::size_t count = 0;
    for (const double side : {1.0, -1.0}) {
      const double elbow = std::atan2(side * sine, cosine);
      const double shoulder = std::atan2(y, x) - std::atan2(lower * std::sin(elbow), upper_arm_ + lower * cosine);
      if (!points_like(pose, tool, shoulder + elbow - bend)) continue;
      found[count] = {near(shoulder / kRad, seed[0]), near((elbow - bend) / kRad, seed[1]), pose.tip[2] - tool.p[2]};
      way[count] = std::hypot(found[count][0] - seed[0], found[count][1] - seed[1]);
      ++count;
    }
    if (count == 2 && way[1] < way[0]) std::swap(found[0], found[1]);
    for (std::size_t i = 0; i < count && (i + 1) * kJoints <= joints.size(); ++i) {
      for (std::size_t j = 0; j < kJoints; ++j) joints[i * kJoints + j] = found[i][j];
    }
    return count;
  }

  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    ToolPose pose;
    forward(joints, tool, pose);
    const double shoulder = joints[0] * kRad;
    const double elbow_x = upper_arm_ * std::cos(shoulder), elbow_y = upper_arm_ * std::sin(shoulder);
    const std::array<std::array<double, kJoints>, 6> rows{{{-kRad * pose.tip[1], -kRad * (pose.tip[1] - elbow_y), 0},
                                                           {kRad * pose.tip[0], kRad * (pose.tip[0] - elbow_x), 0},
                                                           {0, 0, 1},
                                                           {-kRad * pose.axis[1], -kRad * pose.axis[1], 0},
                                                           {kRad * pose.axis[0], kRad * pose.axis[0], 0},
                                                           {0, 0, 0}}};
    for (std::size_t row = 0; row < rows.size(); ++row) {
      for (std::size_t j = 0; j < kJoints; ++j) jacobian[row * kJoints + j] = rows[row][j];
    }
  }

 private:
  /// Whether the tool axis is the pose's with the hand turned to `hand`: it has no joint of its own.
  static bool points_like(const ToolPose& pose, const Frame& tool, double hand) noexcept {
    constexpr double kBound = 1e-9;
    const Vector axis = z_axis(tool);
    const double c = std::cos(hand), s = std::sin(hand);
    return std::abs(c * axis[0] - s * axis[1] - pose.axis[0]) <= kBound &&
           std::abs(s * axis[0] + c * axis[1] - pose.axis[1]) <= kBound && std::abs(axis[2] - pose.axis[2]) <= kBound;
  }
  /// The same direction within half a turn of the seed.
  static double near(double degrees, double seed) noexcept { return seed + std::remainder(degrees - seed, 360); }

  double upper_arm_, forearm_;
};

struct Factory {
  static Kinematics* create(sdk::Parameters parameters, char* error, std::size_t size) noexcept {
    const sdk::NumberParameter upper{"upper_arm", 200, 1, 10000, "mm"}, lower{"forearm", 150, 1, 10000, "mm"};
    double upper_arm = 0, forearm = 0;
    if (!sdk::read_number(parameters, upper, upper_arm, error, size)) return nullptr;
    if (!sdk::read_number(parameters, lower, forearm, error, size)) return nullptr;
    return new TableScara(upper_arm, forearm);
  }
};

}  // namespace

RMAC_MODULE(Kinematics, "TableScaraKinematics", rmac::Kinematics, Factory)
