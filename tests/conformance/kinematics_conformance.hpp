#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "rmac/motion/frame.hpp"
#include "rmac/motion/ports/kinematics.hpp"

namespace rmac::conformance {

struct JointRange {
  double min = 0;
  double max = 0;
};

/// What every kinematics must keep, over seeded random joint vectors inside `ranges` and with several tools: the seeded
/// inverse gives the joints back, the forward of the inverse gives the pose back, the Jacobian is the derivative of the
/// forward (and everywhere the same where it is said to be), joints are of the type they are said to be, and all
/// solutions are solutions, of which the inverse finds the nearest from wherever it is asked. `tools` are those that
/// the machine can carry.
class KinematicsConformance {
 public:
  KinematicsConformance(const Kinematics& kinematics, std::vector<JointRange> ranges, std::vector<Frame> tools)
      : kinematics_(kinematics), ranges_(std::move(ranges)), tools_(std::move(tools)) {}

  void check(unsigned seed = 1, int samples = 2000) const {
    ASSERT_EQ(kinematics_.joint_count(), ranges_.size());
    std::mt19937 random(seed);
    for (int i = 0; i < samples; ++i) {
      std::vector<double> joints;
      for (const JointRange& range : ranges_) {
        joints.push_back(std::uniform_real_distribution<>(range.min, range.max)(random));
      }
      for (const Frame& tool : tools_) {
        SCOPED_TRACE(text(joints));
        check_round_trip(joints, tool);
        check_jacobian(joints, tool);
        check_types(joints, tool);
        check_solutions(joints, tool, random);
        if (testing::Test::HasFailure()) return;
      }
    }
  }

 private:
  static std::string text(const std::vector<double>& joints) {
    std::string result = "joints";
    for (const double joint : joints) result += " " + std::to_string(joint);
    return result;
  }

  void check_round_trip(const std::vector<double>& joints, const Frame& tool) const {
    ToolPose pose;
    kinematics_.forward(joints, tool, pose);
    EXPECT_NEAR(std::hypot(pose.axis[0], pose.axis[1], pose.axis[2]), 1, 1e-12);
    std::vector<double> seed = joints;
    for (double& joint : seed) joint += 1e-3;
    std::vector<double> found(joints.size());
    ASSERT_EQ(kinematics_.inverse(pose, tool, seed, found), KinematicsStatus::Ok);
    ToolPose again;
    kinematics_.forward(found, tool, again);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(again.tip[c], pose.tip[c], 1e-9);
      EXPECT_NEAR(again.axis[c], pose.axis[c], 1e-12);
    }
    for (std::size_t j = 0; j < joints.size(); ++j) EXPECT_NEAR(found[j], joints[j], 1e-9);
  }

  void check_jacobian(const std::vector<double>& joints, const Frame& tool) const {
    const std::size_t n = joints.size();
    std::vector<double> jacobian(6 * n, std::nan(""));
    kinematics_.jacobian(joints, tool, jacobian);
    if (kinematics_.constant_jacobian()) {
      std::vector<double> elsewhere(6 * n, std::nan(""));
      kinematics_.jacobian(std::vector<double>(n, 0.0), tool, elsewhere);
      EXPECT_EQ(jacobian, elsewhere);
    }
    constexpr double kStep = 1e-4;
    for (std::size_t j = 0; j < n; ++j) {
      std::vector<double> up = joints;
      std::vector<double> down = joints;
      up[j] += kStep;
      down[j] -= kStep;
      ToolPose above;
      ToolPose below;
      kinematics_.forward(up, tool, above);
      kinematics_.forward(down, tool, below);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(jacobian[c * n + j], (above.tip[c] - below.tip[c]) / (2 * kStep), 1e-6);
        EXPECT_NEAR(jacobian[(3 + c) * n + j], (above.axis[c] - below.axis[c]) / (2 * kStep), 1e-6);
      }
    }
  }

  /// A slide carries tip and axis along by as much as it moves, and turns nothing; a turn keeps no axis but its own.
  void check_types(const std::vector<double>& joints, const Frame& tool) const {
    const std::size_t n = joints.size();
    std::vector<double> jacobian(6 * n);
    kinematics_.jacobian(joints, tool, jacobian);
    for (std::size_t j = 0; j < n; ++j) {
      const auto length = [&](std::size_t row) {
        return std::hypot(jacobian[row * n + j], jacobian[(row + 1) * n + j], jacobian[(row + 2) * n + j]);
      };
      if (kinematics_.joint_type(j) == JointType::Linear) {
        EXPECT_NEAR(length(0), 1, 1e-9);
        EXPECT_NEAR(length(3), 0, 1e-9);
      } else if (kinematics_.joint_type(j) == JointType::Rotary) {
        EXPECT_LE(length(3), std::numbers::pi / 180 + 1e-9);
      }
    }
  }

  /// Of a pose whose joints are known, asked for from random joints.
  void check_solutions(const std::vector<double>& joints, const Frame& tool, std::mt19937& random) const {
    const std::size_t n = joints.size();
    ToolPose pose;
    kinematics_.forward(joints, tool, pose);
    std::vector<double> seed;
    for (const JointRange& range : ranges_) {
      seed.push_back(std::uniform_real_distribution<>(range.min, range.max)(random));
    }
    constexpr std::size_t kMost = 16;
    std::vector<double> all(kMost * n);
    const std::size_t count = kinematics_.solutions(pose, tool, seed, all);
    ASSERT_GE(count, 1U);
    ASSERT_LE(count, kMost);
    double shortest = 0;
    bool found_again = false;
    for (std::size_t i = 0; i < count; ++i) {
      const std::vector<double> solution(all.begin() + static_cast<std::ptrdiff_t>(i * n),
                                         all.begin() + static_cast<std::ptrdiff_t>((i + 1) * n));
      ToolPose again;
      kinematics_.forward(solution, tool, again);
      double way = 0, off = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(again.tip[c], pose.tip[c], 1e-9) << "solution " << i << ": " << text(solution);
        EXPECT_NEAR(again.axis[c], pose.axis[c], 1e-12) << "solution " << i << ": " << text(solution);
      }
      for (std::size_t j = 0; j < n; ++j) {
        const bool turns = kinematics_.joint_type(j) == JointType::Rotary;
        if (turns) {
          EXPECT_LE(std::abs(solution[j] - seed[j]), 180 + 1e-9);
          way += (solution[j] - seed[j]) * (solution[j] - seed[j]);
        }
        off = std::max(off, std::abs(turns ? std::remainder(solution[j] - joints[j], 360) : solution[j] - joints[j]));
      }
      found_again = found_again || off < 1e-7;
      EXPECT_GE(way, shortest) << "the nearest comes first";
      if (i == 0) {
        shortest = way;
        std::vector<double> one(n);
        ASSERT_EQ(kinematics_.inverse(pose, tool, seed, one), KinematicsStatus::Ok);
        for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(one[j], solution[j], 1e-9) << "inverse finds the nearest";
      }
    }
    EXPECT_TRUE(found_again) << "the joints that the pose was made of are not among " << count << " solutions";
  }

  const Kinematics& kinematics_;
  std::vector<JointRange> ranges_;
  std::vector<Frame> tools_;
};

}  // namespace rmac::conformance
