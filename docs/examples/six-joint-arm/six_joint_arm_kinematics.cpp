#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"
#include "rmac/motion/vector.hpp"
#include "rmac/sdk/parameters.hpp"

namespace {

using namespace rmac;

constexpr double kRad = std::numbers::pi / 180;
constexpr std::size_t kJoints = 6, kSpin = 5;
constexpr double kNothing = 1e-9;
using Joints = std::array<double, kJoints>;

struct Lengths {
  double shoulder, upper_arm, forearm, hand;  ///< mm
};

Frame turned(std::size_t axis, double degrees) noexcept {
  Frame frame;
  frame.q[0] = std::cos(degrees * kRad / 2);
  frame.q[1 + axis] = std::sin(degrees * kRad / 2);
  return frame;
}
Frame moved(const Vector& by) noexcept {
  return {by, {1, 0, 0, 0}};
}

/// Waist about z; shoulder and elbow about y; then three turns whose axes meet in the wrist: of the forearm about
/// itself, of the hand about y, and of the hand about itself. At zero the upper arm is upright, the forearm level along
/// x, and the hand hangs down.
///
/// Where the tool's tip and axis lie on the hand's own line, as of a spindle or a dispenser, the last turn changes
/// nothing. So it is left over, and the wrist follows from the pose: the inverse is in closed form.
class SixJointArm final : public Kinematics {
 public:
  explicit SixJointArm(const Lengths& lengths) : lengths_(lengths) {}

  std::size_t joint_count() const noexcept override { return kJoints; }
  JointType joint_type(std::size_t) const noexcept override { return JointType::Rotary; }
  std::optional<std::size_t> free_joint() const noexcept override { return kSpin; }
  bool takes(const Frame& tool) const noexcept override {
    return std::hypot(tool.p[0], tool.p[1]) <= kNothing && distance(z_axis(tool), {0, 0, 1}) <= kNothing;
  }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    const Frame tip = compose(chain(joints).back(), tool);
    pose = {tip.p, z_axis(tip)};
  }

  KinematicsStatus inverse(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                           std::span<double> joints) const noexcept override {
    std::array<Joints, 8> found;
    if (find(pose, tool, seed, found) == 0) return KinematicsStatus::OutOfReach;
    std::copy(found[0].begin(), found[0].end(), joints.begin());
    return KinematicsStatus::Ok;
  }

  std::size_t solutions(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                        std::span<double> joints) const noexcept override {
    std::array<Joints, 8> found;
    const std::size_t count = find(pose, tool, seed, found);
    for (std::size_t i = 0; i < count && (i + 1) * kJoints <= joints.size(); ++i) {
      std::copy(found[i].begin(), found[i].end(), joints.begin() + static_cast<std::ptrdiff_t>(i * kJoints));
    }
    return count;
  }

  /// A turn moves the tip at right angles to its axis, and the tool's axis too.
  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    static constexpr std::array<std::size_t, kJoints> kAxes{2, 1, 1, 0, 1, 2};
    const auto frames = chain(joints);
    const Frame tip = compose(frames.back(), tool);
    for (std::size_t j = 0; j < kJoints; ++j) {
      Vector axis{};
      axis[kAxes[j]] = kRad;
      axis = rotate(frames[j].q, axis);
      const Vector by_tip = cross(axis, difference(tip.p, frames[j].p)), by_axis = cross(axis, z_axis(tip));
      for (std::size_t row = 0; row < 3; ++row) {
        jacobian[row * kJoints + j] = by_tip[row];
        jacobian[(row + 3) * kJoints + j] = by_axis[row];
      }
    }
  }

 private:
  /// Behind each of the joints; the last one is the tool interface.
  std::array<Frame, kJoints + 1> chain(std::span<const double> joints) const noexcept {
    const auto& [shoulder, upper_arm, forearm, hand] = lengths_;
    std::array<Frame, kJoints + 1> frames;
    frames[0] = turned(2, joints[0]);
    frames[1] = compose(compose(frames[0], moved({0, 0, shoulder})), turned(1, joints[1]));
    frames[2] = compose(compose(frames[1], moved({0, 0, upper_arm})), turned(1, joints[2]));
    frames[3] = compose(compose(frames[2], moved({forearm, 0, 0})), turned(0, joints[3]));
    frames[4] = compose(frames[3], turned(1, joints[4]));
    frames[5] = compose(frames[4], turned(2, joints[5]));
    frames[6] = compose(frames[5], moved({0, 0, -hand}));
    return frames;
  }

  /// All solutions, the nearest to the seed first: the waist either way round, the elbow up or down, the wrist bent to
  /// either side.
  std::size_t find(const ToolPose& pose, const Frame& tool, std::span<const double> seed,
                   std::array<Joints, 8>& found) const noexcept {
    const Vector wrist = along(pose.tip, lengths_.hand - tool.p[2], pose.axis);
    const double out = std::hypot(wrist[0], wrist[1]);
    if (!takes(tool) || !finite(wrist)) return 0;
    std::size_t count = 0;
    for (const double side : {1.0, -1.0}) {
      // Above the waist every direction is as good: it stays.
      const double waist = out < kNothing ? seed[0] : std::atan2(wrist[1], wrist[0]) / kRad + (side > 0 ? 0.0 : 180.0);
      for (const bool elbow_up : {true, false}) {
        Joints joints{waist};
        if (!bend_arm(side * out, wrist[2] - lengths_.shoulder, elbow_up, joints)) return 0;
        for (const double bent : {1.0, -1.0}) {
          bend_wrist(pose.axis, bent, seed, joints);
          for (std::size_t j = 0; j < kSpin; ++j) joints[j] = seed[j] + std::remainder(joints[j] - seed[j], 360);
          joints[kSpin] = seed[kSpin];
          found[count++] = joints;
        }
      }
    }
    const auto way = [&](const Joints& joints) {
      double sum = 0;
      for (std::size_t j = 0; j < kSpin; ++j) sum += (joints[j] - seed[j]) * (joints[j] - seed[j]);
      return sum;
    };
    std::sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(count),
              [&](const Joints& one, const Joints& other) { return way(one) < way(other); });
    return count;
  }

  /// Shoulder and elbow for a wrist so far out and so far above the shoulder; false where the arm is too short or too
  /// long for that.
  bool bend_arm(double out, double up, bool elbow_up, Joints& joints) const noexcept {
    const double upper = lengths_.upper_arm, fore = lengths_.forearm, far2 = out * out + up * up;
    const double sine = (upper * upper + fore * fore - far2) / (2 * upper * fore);
    constexpr double kRounding = 1e-12;
    if (!(std::abs(sine) <= 1 + kRounding)) return false;
    const double level = std::asin(std::clamp(sine, -1.0, 1.0));
    const double elbow = elbow_up ? level : std::numbers::pi - level;
    const double ahead = upper - fore * std::sin(elbow), aside = fore * std::cos(elbow);
    joints[1] = std::atan2(ahead * out - aside * up, ahead * up + aside * out) / kRad;
    joints[2] = elbow / kRad;
    return true;
  }

  /// Forearm and wrist for a direction of the hand; in line with the forearm any turn of that will do, and it stays.
  static void bend_wrist(const Vector& axis, double bent, std::span<const double> seed, Joints& joints) noexcept {
    const Frame forearm = compose(turned(2, joints[0]), turned(1, joints[1] + joints[2]));
    const Vector hand = rotate(rmac::inverse(forearm).q, axis);
    const double aside = std::hypot(hand[1], hand[2]);
    joints[3] = aside < kNothing ? seed[3] : std::atan2(-bent * hand[1], bent * hand[2]) / kRad;
    joints[4] = std::atan2(hand[0], bent * aside) / kRad;
  }

  Lengths lengths_;
};

struct Factory {
  static Kinematics* create(sdk::Parameters parameters, char* error, std::size_t size) noexcept {
    Lengths lengths{};
    const auto read = [&](const char* name, double usual, double& value) {
      return sdk::read_number(parameters, {name, usual, 1, 10000, "mm"}, value, error, size);
    };
    const bool fine = read("shoulder", 300, lengths.shoulder) && read("upper_arm", 250, lengths.upper_arm) &&
                      read("forearm", 220, lengths.forearm) && read("hand", 60, lengths.hand);
    return fine ? new SixJointArm(lengths) : nullptr;
  }
};

}  // namespace

RMAC_MODULE(Kinematics, "SixJointArmKinematics", rmac::Kinematics, Factory)
