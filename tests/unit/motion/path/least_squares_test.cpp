#include "path/least_squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace rmac {
namespace {

/// So many rotary joints; the equations ask for nothing else.
class Turns final : public Kinematics {
 public:
  explicit Turns(std::size_t joints) : joints_(joints) {}
  [[nodiscard]] std::size_t joint_count() const noexcept override { return joints_; }
  [[nodiscard]] JointType joint_type(std::size_t) const noexcept override { return JointType::Rotary; }
  void forward(std::span<const double>, const Frame&, ToolPose&) const noexcept override {}
  [[nodiscard]] KinematicsStatus inverse(const ToolPose&, const Frame&, std::span<const double>,
                                         std::span<double>) const noexcept override {
    return KinematicsStatus::OutOfReach;
  }
  void jacobian(std::span<const double>, const Frame&, std::span<double>) const noexcept override {}

 private:
  std::size_t joints_;
};

/// A Jacobian in which one joint moves nothing but for rounding, and a pose's derivative that the others can answer.
struct Case {
  explicit Case(unsigned seed) : chance(seed) {
    joints = 2 + seed % 5;
    free = std::uniform_int_distribution<std::size_t>(0, joints - 1)(chance);
    for (std::size_t j = 0; j < joints; ++j) {
      const double magnitude = j == free ? 0 : std::pow(10, std::uniform_real_distribution(-1.0, 1.5)(chance));
      for (std::size_t r = 0; r < 6; ++r) rows[r * joints + j] = magnitude * unit(chance);
    }
    for (std::size_t j = 0; j < joints; ++j) wanted[j] = j == free ? 0 : unit(chance);
    for (std::size_t r = 0; r < 6; ++r) {
      for (std::size_t j = 0; j < joints; ++j) pose[r] += rows[r * joints + j] * wanted[j];
    }
  }
  void add_rounding() {
    const double magnitude = std::pow(10, std::uniform_real_distribution(-19.0, -13.0)(chance));
    for (std::size_t r = 0; r < 6; ++r) rows[r * joints + free] = magnitude * unit(chance);
  }

  std::mt19937 chance;
  std::uniform_real_distribution<double> unit{-1, 1};
  std::size_t joints = 0, free = 0;
  PoseRows rows{};
  PoseColumn pose{};
  JointColumn wanted{};
};

TEST(LeastSquares, AFreeJointStaysAtRestWhateverRoundingLeavesInItsColumn) {
  for (unsigned seed = 0; seed < 2000; ++seed) {
    Case each(seed);
    each.add_rounding();
    const Turns turns(each.joints);
    const LeastSquares squares(each.rows, turns);
    EXPECT_FALSE(squares.full_rank()) << "seed " << seed;
    JointColumn x;
    ASSERT_TRUE(squares.solve(each.pose, x)) << "seed " << seed;
    for (std::size_t j = 0; j < each.joints; ++j) {
      EXPECT_NEAR(x[j], each.wanted[j], 1e-6) << "seed " << seed << " joint " << j;
    }
  }
}

}  // namespace
}  // namespace rmac
