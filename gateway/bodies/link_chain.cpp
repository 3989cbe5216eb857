#include "gateway/bodies/link_chain.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/bodies/link.hpp"
#include "rmac/motion/frame.hpp"

namespace rmac::gateway {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kRadPerDegree = std::numbers::pi / 180;
constexpr int kComparisons = 64;
constexpr double kAgree_mm = 1e-6;    ///< times the size of the machine
constexpr double kFarAside_mm = 100;  ///< of the points by which the tool's whole frame is asked for

Vector3d to_eigen(const Vector& v) {
  return {v[0], v[1], v[2]};
}
Vector to_vector(const Vector3d& v) {
  return {v[0], v[1], v[2]};
}

/// Tips of four tools tell where the tool interface stands and how it is turned.
Eigen::Isometry3d interface_at(const Kinematics& kinematics, std::span<const double> joints) {
  const auto tip = [&](const Vector& offset) {
    return to_eigen(pose_of(kinematics, joints, Frame{offset, {1, 0, 0, 0}}).tip);
  };
  Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
  at.translation() = tip({0, 0, 0});
  Matrix3d turn;
  turn.col(0) = (tip({kFarAside_mm, 0, 0}) - at.translation()) / kFarAside_mm;
  turn.col(1) = (tip({0, kFarAside_mm, 0}) - at.translation()) / kFarAside_mm;
  turn.col(2) = (tip({0, 0, kFarAside_mm}) - at.translation()) / kFarAside_mm;
  at.linear() = turn;
  return at;
}

/// So far that rounding does not matter, and not so far that a turn is taken for another.
double amount_asked(JointType type) {
  constexpr double kSlide_mm = 100, kTurn_deg = 90, kScrew_mm = 0.1;
  return type == JointType::Linear ? kSlide_mm : type == JointType::Rotary ? kTurn_deg : kScrew_mm;
}

/// J of the exponential: the way of the origin is J times the slide (Lynch and Park, Modern Robotics, 3.88).
Matrix3d left_jacobian(const Vector3d& turn) {
  const double angle = turn.norm();
  Matrix3d cross;
  cross << 0, -turn[2], turn[1], turn[2], 0, -turn[0], -turn[1], turn[0], 0;
  const double a = angle < 1e-9 ? 0.5 : (1 - std::cos(angle)) / (angle * angle);
  const double b = angle < 1e-9 ? 1.0 / 6 : (angle - std::sin(angle)) / (angle * angle * angle);
  return Matrix3d::Identity() + a * cross + b * cross * cross;
}

Frame to_frame(const Eigen::Isometry3d& at) {
  const Eigen::Quaterniond q(at.linear());
  return {to_vector(at.translation()), {q.w(), q.x(), q.y(), q.z()}};
}

double distance(const Vector& a, const Vector& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

}  // namespace

Frame LinkChain::moved_by(const Screw& screw, double amount) noexcept {
  const Vector3d turn = to_eigen(screw.turn) * amount;
  const Vector3d way = left_jacobian(turn) * (to_eigen(screw.slide) * amount);
  const double half = turn.norm() / 2;
  const double s = half < 1e-12 ? 0.5 : std::sin(half) / (2 * half);
  return {to_vector(way), {std::cos(half), s * turn[0], s * turn[1], s * turn[2]}};
}

Expected<LinkChain> LinkChain::make(const Kinematics& kinematics, std::span<const std::string> chain,
                                    std::span<const std::string> names,
                                    std::span<const std::pair<double, double>> limits) {
  LinkChain made;
  for (const std::string& name : chain) {
    if (name == kBase) continue;
    made.order_.push_back(static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin()));
  }
  std::vector<double> joints(names.size(), 0.0);
  const Eigen::Isometry3d home = interface_at(kinematics, joints);
  made.interface_home_ = to_frame(home);
  for (std::size_t j = 0; j < names.size(); ++j) {
    const double amount = amount_asked(kinematics.joint_type(j));
    joints[j] = amount;
    const Eigen::Isometry3d moved = interface_at(kinematics, joints) * home.inverse();
    joints[j] = 0;
    const Eigen::AngleAxisd turn(Matrix3d(moved.linear()));
    const Vector3d whole =
        kinematics.joint_type(j) == JointType::Linear ? Vector3d(0, 0, 0) : Vector3d(turn.axis() * turn.angle());
    const Vector3d slide = left_jacobian(whole).inverse() * moved.translation() / amount;
    const Vector3d rate = whole / amount;
    made.screws_.push_back({to_vector(rate), to_vector(slide)});
    Motion motion;
    motion.turns = rate.norm();
    if (motion.turns > 0) {
      const Vector3d along = rate / motion.turns;
      motion.direction = to_vector(along);
      motion.slides = std::abs(slide.dot(along));
      motion.point = to_vector(along.cross(slide) / motion.turns);
    } else {
      motion.slides = slide.norm();
    }
    made.motions_.push_back(motion);
  }
  // With the order of the joints wrong, or with arms that are no chain, the product differs from the module somewhere.
  std::mt19937_64 random(19);
  std::vector<Frame> frames(made.link_count());
  for (int i = 0; i < kComparisons; ++i) {
    double size = 1;
    for (std::size_t j = 0; j < names.size(); ++j) {
      joints[j] = std::uniform_real_distribution<double>(limits[j].first, limits[j].second)(random);
      size = std::max(size, std::abs(joints[j]));
    }
    if (!kinematics.has_pose(joints)) continue;
    made.displace(joints, frames);
    const Frame product = compose(frames.back(), made.interface_home_);
    const Eigen::Isometry3d module = interface_at(kinematics, joints);
    for (const Vector& offset : {Vector{0, 0, 0}, Vector{kFarAside_mm, 0, 0}, Vector{0, 0, kFarAside_mm}}) {
      const double apart = distance(apply_to_point(product, offset), to_vector(module * to_eigen(offset)));
      if (apart <= kAgree_mm * size) continue;
      return failure(MinorCode::InvalidParameterValue,
                     fmt::format("/Chain is {}, and the kinematics module moves the tool otherwise: at {} = {:.6g} the "
                                 "two are {:.3g} mm apart; the joints do not stand on each other in this order",
                                 fmt::join(chain, " "), fmt::join(names, ", "), fmt::join(joints, ", "), apart));
    }
  }
  return made;
}

Expected<LinkChain> LinkChain::make(const Kinematics& kinematics, std::span<const std::string> chain,
                                    std::span<const JointLimits> joints) {
  constexpr double kEndless = 400;
  std::vector<std::string> names;
  std::vector<std::pair<double, double>> limits;
  for (const JointLimits& joint : joints) {
    names.push_back(joint.name);
    limits.emplace_back(ends_below(joint) ? joint.min : -kEndless, ends_above(joint) ? joint.max : kEndless);
  }
  return make(kinematics, chain, names, limits);
}

void LinkChain::displace(std::span<const double> joints, std::span<Frame> frames) const noexcept {
  frames[0] = Frame{};
  for (std::size_t k = 0; k < order_.size(); ++k) {
    frames[k + 1] = compose(frames[k], moved_by(screws_[order_[k]], joints[order_[k]]));
  }
}

}  // namespace rmac::gateway
