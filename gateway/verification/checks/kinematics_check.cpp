#include "gateway/verification/checks/kinematics_check.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <random>

#include "gateway/verification/checks/pose_bounds.hpp"

namespace rmac::verifier {
namespace {

constexpr double kTipBound_mm = kExact.tip_mm, kAxisBound_rad = kExact.axis_rad;
/// How much the pose must change, mm and rad alike, a mm or degree of a joint in the worst direction, for the inverse
/// to be held to giving the joints back: to what the bounds above leave open.
constexpr double kDetermined = 1e-4;

using Joints = std::vector<double>;

class KinematicsCheck {
 public:
  KinematicsCheck(const Kinematics& kinematics, const KinematicsCase& given)
      : kinematics_(kinematics),
        given_(given),
        n_(given.ranges.size()),
        random_(given.seed),
        jacobian_(6 * n_),
        all_(kMostSolutions * n_) {}

  Checked run() {
    if (kinematics_.joint_count() != n_) {
      return found("joints", fmt::format("it has {} joints, {} are wanted", kinematics_.joint_count(), n_), -1, {});
    }
    if (kinematics_.free_joint().value_or(0) >= n_) {
      return found("joints", fmt::format("it leaves over joint {} of {}", *kinematics_.free_joint(), n_), -1, {});
    }
    for (const Joints& joints : special_joints()) {
      if (auto fine = at(joints); !fine) return fine;
    }
    for (int i = 0; i < given_.samples; ++i) {
      if (auto fine = at(random_joints()); !fine) return fine;
    }
    if (const auto few = too_few_poses()) return *few;
    const std::size_t by_pose = kinematics_.free_joint() ? n_ - 1 : n_;
    if (determined_ == 0 && by_pose <= 5) {
      return found("Jacobian", "it says of no joint vector that the pose determines it", -1, {});
    }
    return check_no_number();
  }

 private:
  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  Joints random_joints() {
    Joints joints;
    for (const JointRange& range : given_.ranges) joints.push_back(random(range.min, range.max));
    return joints;
  }
  [[nodiscard]] bool turns(std::size_t joint) const { return kinematics_.joint_type(joint) == JointType::Rotary; }

  /// Where geometries break: corners, ends, quarter turns, and what is close to those.
  std::vector<Joints> special_joints() {
    std::vector<Joints> result;
    for (std::size_t corner = 0; corner < std::size_t{1} << std::min<std::size_t>(n_, 6); ++corner) {
      Joints joints;
      for (std::size_t j = 0; j < n_; ++j) {
        joints.push_back((corner >> j & 1U) != 0 ? given_.ranges[j].max : given_.ranges[j].min);
      }
      result.push_back(joints);
    }
    for (std::size_t j = 0; j < n_; ++j) {
      const auto add = [&](double value) {
        if (value < given_.ranges[j].min || value > given_.ranges[j].max) return;
        Joints joints = random_joints();
        joints[j] = value;
        result.push_back(std::move(joints));
      };
      add(given_.ranges[j].min);
      add(given_.ranges[j].max);
      constexpr double kQuarter = 90;
      for (int turn = -8; turns(j) && turn <= 8; ++turn) {
        for (const double off : {0.0, 1e-9, -1e-6, 1e-4}) add(turn * kQuarter + off);
      }
    }
    Joints zero;
    for (const JointRange& range : given_.ranges) zero.push_back(std::clamp(0.0, range.min, range.max));
    result.push_back(zero);
    return result;
  }

  Checked at(const Joints& joints) {
    ++asked_;
    if (!has_room(joints)) return given_.misdeed ? given_.misdeed() : Checked();
    ++with_pose_;
    return misdeed_or(given_.misdeed, holds_at(joints));
  }

  /// Whether joints have a pose, and whatever is near: where poses end, the forward is too steep for differences.
  bool has_room(const Joints& joints) const {
    constexpr double kRoom = 1;  // mm or degrees
    if (!kinematics_.has_pose(joints)) return false;
    Joints moved = joints;
    for (std::size_t j = 0; j < n_; ++j) {
      for (const double by : {-kRoom, kRoom}) {
        moved[j] = joints[j] + by;
        if (!kinematics_.has_pose(moved)) return false;
      }
      moved[j] = joints[j];
    }
    return true;
  }

  [[nodiscard]] std::optional<tl::unexpected<CounterExample>> too_few_poses() const {
    constexpr double kLeast = 0.02;
    const double share = static_cast<double>(with_pose_) / static_cast<double>(asked_);
    if (share >= kLeast) return std::nullopt;
    return found("poses",
                 fmt::format("of {} joint vectors within their travel {} have a pose, {} % at least are to: narrow the "
                             "travel to where the tool can be",
                             asked_, with_pose_, 100 * kLeast),
                 -1, {});
  }

  Checked holds_at(const Joints& joints) {
    joints_ = joints;
    tool_ = given_.tools[static_cast<std::size_t>(sample_) % given_.tools.size()];
    kinematics_.forward(joints_, tool_, pose_);
    const double length = std::hypot(pose_.axis[0], pose_.axis[1], pose_.axis[2]);
    if (!(std::abs(length - 1) <= kAxisBound_rad) || !std::isfinite(pose_.tip[0] + pose_.tip[1] + pose_.tip[2])) {
      return fault("forward", fmt::format("the tool axis has length {}, or the tip is no number", length),
                   {named_pose("pose", pose_)});
    }
    // The solutions cost as much as all else together, and are the same code for each sample.
    constexpr int kSolutionsEvery = 5;
    auto fine = check_jacobian().and_then([&] { return check_types(); }).and_then([&] { return check_inverse(); });
    if (fine && sample_ % kSolutionsEvery == 0) {
      fine = check_solutions();
    }
    ++sample_;
    return fine;
  }

  [[nodiscard]] tl::unexpected<CounterExample> fault(const char* check, std::string what,
                                                     std::vector<NamedNumbers> more = {}) const {
    std::vector<NamedNumbers> values{named("joints", joints_), named_tool(tool_)};
    for (NamedNumbers& value : more) values.push_back(std::move(value));
    return found(check, std::move(what), sample_, std::move(values));
  }

  Checked check_jacobian() {
    std::fill(jacobian_.begin(), jacobian_.end(), std::nan(""));
    kinematics_.jacobian(joints_, tool_, jacobian_);
    if (kinematics_.constant_jacobian()) {
      Joints elsewhere(6 * n_, std::nan(""));
      kinematics_.jacobian(Joints(n_, 0.0), tool_, elsewhere);
      if (jacobian_ != elsewhere) {
        return fault("Jacobian", "it is not what it is at zero, and is said to be the same at all joints");
      }
    }
    constexpr double kStep = 1e-4, kBound = 1e-6;
    Joints moved = joints_;
    for (std::size_t j = 0; j < n_; ++j) {
      ToolPose above, below;
      moved[j] = joints_[j] + kStep;
      kinematics_.forward(moved, tool_, above);
      moved[j] = joints_[j] - kStep;
      kinematics_.forward(moved, tool_, below);
      moved[j] = joints_[j];
      for (std::size_t row = 0; row < 6; ++row) {
        const double rise = row < 3 ? above.tip[row] - below.tip[row] : above.axis[row - 3] - below.axis[row - 3];
        const double derivative = rise / (2 * kStep), off = jacobian_[row * n_ + j] - derivative;
        if (!(std::abs(off) <= kBound)) {
          return fault("Jacobian", fmt::format("row {}, column {} is {}, the forward changes by {} a mm or degree", row,
                                               j, jacobian_[row * n_ + j], derivative));
        }
      }
    }
    return {};
  }

  /// A slide carries tip and axis along by as much as it moves, and turns nothing; a turn turns the axis by no more
  /// than itself. Joints of a parallel machine do as they like.
  Checked check_types() {
    if (kinematics_.parallel()) return {};
    for (std::size_t j = 0; j < n_; ++j) {
      const auto length = [&](std::size_t row) {
        return std::hypot(jacobian_[row * n_ + j], jacobian_[(row + 1) * n_ + j], jacobian_[(row + 2) * n_ + j]);
      };
      const double tip = length(0), axis = length(3);
      if (kinematics_.joint_type(j) == JointType::Linear && !(std::abs(tip - 1) <= 1e-9 && axis <= 1e-9)) {
        return fault("joint types",
                     fmt::format("joint {} is said to slide, but moves the tip by {} mm a mm and turns the axis by {}",
                                 j, tip, axis));
      }
      if (turns(j) && !(axis <= std::numbers::pi / 180 + 1e-9)) {
        return fault("joint types",
                     fmt::format("joint {} is said to turn, but turns the axis by {} rad a degree", j, axis));
      }
    }
    return {};
  }

  /// Least change of the pose a unit of joint motion, in the worst direction of the joints but the one left over.
  [[nodiscard]] double determination() const {
    Eigen::MatrixXd rows(6, static_cast<Eigen::Index>(n_));
    Eigen::Index columns = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      if (kinematics_.free_joint() == j) continue;
      for (std::size_t r = 0; r < 6; ++r) rows(static_cast<Eigen::Index>(r), columns) = jacobian_[r * n_ + j];
      ++columns;
    }
    rows.conservativeResize(Eigen::NoChange, columns);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(rows.transpose() * rows, Eigen::EigenvaluesOnly);
    return std::sqrt(std::max(0.0, solver.eigenvalues()[0]));
  }

  /// By how much the forward of `joints` misses the pose at hand, in words; nothing where it does not.
  [[nodiscard]] std::optional<std::string> miss(std::span<const double> joints) const {
    return verifier::miss(kinematics_, joints, tool_, pose_);
  }

  Checked check_inverse() {
    constexpr double kNearby = 1e-3;
    Joints seed = joints_, answer(n_, std::nan(""));
    for (double& joint : seed) joint += random(-kNearby, kNearby);
    if (const auto left_over = kinematics_.free_joint()) seed[*left_over] = joints_[*left_over];
    const auto shown = [&] {
      return std::vector{named_pose("pose", pose_), named("seed", seed), named("answer", answer)};
    };
    if (kinematics_.inverse(pose_, tool_, seed, answer) != KinematicsStatus::Ok) {
      return fault("inverse", "it finds no joints for a pose that joints within their travel give", shown());
    }
    if (const auto off = miss(answer)) return fault("inverse", *off, shown());
    if (const auto moved = free_moved(answer, seed)) return fault("inverse", *moved, shown());
    const double determined = determination();
    if (determined < kDetermined) return {};
    ++determined_;
    for (std::size_t j = 0; j < n_; ++j) {
      const double off = std::abs(answer[j] - joints_[j]), bound = kTipBound_mm * std::max(1.0, 1 / determined);
      if (!(off <= bound)) {
        return fault("seeded inverse",
                     fmt::format("joint {} comes back {} off where it was, seeded within {} of it", j, off, kNearby),
                     shown());
      }
    }
    return {};
  }

  /// What is wrong with the joint that the pose leaves over, in words.
  [[nodiscard]] std::optional<std::string> free_moved(std::span<const double> answer,
                                                      std::span<const double> seed) const {
    constexpr double kRounding = 1e-9;
    const auto left_over = kinematics_.free_joint();
    if (!left_over || std::abs(answer[*left_over] - seed[*left_over]) <= kRounding) return std::nullopt;
    return fmt::format("it leaves joint {} over, and moves it from {} to {}", *left_over, seed[*left_over],
                       answer[*left_over]);
  }

  Checked check_solutions() {
    Joints seed = random_joints();
    if (const auto left_over = kinematics_.free_joint()) seed[*left_over] = joints_[*left_over];
    const auto shown = [&](std::span<const double> solution) {
      return std::vector{named_pose("pose", pose_), named("seed", seed), named("solution", solution)};
    };
    std::fill(all_.begin(), all_.end(), std::nan(""));
    const std::size_t count = kinematics_.solutions(pose_, tool_, seed, all_);
    if (count == 0 || count > kMostSolutions) {
      return fault("solutions",
                   fmt::format("there are said to be {}; there is one at least, and {} at most", count, kMostSolutions),
                   {named_pose("pose", pose_), named("seed", seed)});
    }
    const bool determined = determination() >= kDetermined;
    double way_before = 0;
    bool found_again = false;
    for (std::size_t i = 0; i < count; ++i) {
      const std::span<const double> solution(all_.data() + i * n_, n_);
      if (const auto off = miss(solution)) return fault("solutions", *off, shown(solution));
      if (const auto moved = free_moved(solution, seed)) return fault("solutions", *moved, shown(solution));
      double way = 0, off = 0;
      for (std::size_t j = 0; j < n_; ++j) {
        const double turn = solution[j] - seed[j], by = solution[j] - joints_[j];
        off = std::max(off, std::abs(turns(j) ? std::remainder(by, 360) : by));
        if (!turns(j)) continue;
        way += turn * turn;
        if (!(std::abs(turn) <= 180 + 1e-6)) {
          return fault("solutions", fmt::format("joint {} is {} degrees from the seed, more than half a turn", j, turn),
                       shown(solution));
        }
      }
      if (way < way_before - 1e-6) {
        return fault("solutions", "one comes after another that is further from the seed", shown(solution));
      }
      way_before = way;
      found_again = found_again || off <= kTipBound_mm / kDetermined;
    }
    if (determined && !found_again) {
      return fault("solutions", fmt::format("the joints that the pose was made of are not among the {}", count),
                   {named_pose("pose", pose_), named("seed", seed)});
    }
    return determined ? check_nearest(seed) : Checked();
  }

  /// The inverse finds the first of the solutions; of two as near as each other, either.
  Checked check_nearest(const Joints& seed) {
    Joints answer(n_, std::nan(""));
    const bool reached = kinematics_.inverse(pose_, tool_, seed, answer) == KinematicsStatus::Ok;
    double way = 0, shortest = 0;
    for (std::size_t j = 0; j < n_; ++j) {
      if (!turns(j)) continue;
      way += (answer[j] - seed[j]) * (answer[j] - seed[j]);
      shortest += (all_[j] - seed[j]) * (all_[j] - seed[j]);
    }
    if (reached && way <= shortest + 1e-6) return {};
    return fault("inverse", "it does not give the solution that is nearest to the seed",
                 {named_pose("pose", pose_), named("seed", seed), named("answer", answer),
                  named("nearest", std::span(all_).first(n_))});
  }

  Checked check_no_number() {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    Joints answer(n_);
    for (const ToolPose& pose : {ToolPose{{0, 0, nan}, {0, 0, 1}}, ToolPose{{0, 0, 0}, {nan, 0, 1}}}) {
      if (kinematics_.inverse(pose, {}, Joints(n_, 0.0), answer) == KinematicsStatus::Ok) {
        return found("inverse", "it finds joints for a pose that is no number", sample_, {named_pose("pose", pose)});
      }
    }
    return {};
  }

  const Kinematics& kinematics_;
  const KinematicsCase& given_;
  std::size_t n_;
  std::mt19937_64 random_;
  std::int64_t sample_ = 0;
  std::int64_t determined_ = 0;             ///< samples whose joints the pose determines
  std::int64_t asked_ = 0, with_pose_ = 0;  ///< joint vectors

  Joints joints_;  ///< of the sample at hand, with the three below
  Frame tool_;
  ToolPose pose_;
  std::vector<double> jacobian_;
  std::vector<double> all_;
};

}  // namespace

Checked check_kinematics(const Kinematics& kinematics, const KinematicsCase& given) {
  return KinematicsCheck(kinematics, given).run();
}

}  // namespace rmac::verifier
