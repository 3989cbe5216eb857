#include "gateway/verification/checks/reach_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "gateway/verification/checks/pose_bounds.hpp"
#include "rmac/motion/vector.hpp"

namespace rmac::verifier {
namespace {

constexpr int kSamplesPerWay = 50;

/// Leads the tool away from a pose that it can have: straight on, tilting, or both.
struct Way {
  ToolPose from;
  Vector along_mm{}, tilts_to{};
  double tilt_rad = 0;

  [[nodiscard]] ToolPose at(double part) const {
    const double angle = part * tilt_rad, c = std::cos(angle), s = std::sin(angle);
    ToolPose pose;
    for (std::size_t i = 0; i < 3; ++i) {
      pose.tip[i] = from.tip[i] + part * along_mm[i];
      pose.axis[i] = c * from.axis[i] + s * tilts_to[i];
    }
    return pose;
  }
};

class ReachCheck {
 public:
  ReachCheck(const Kinematics& kinematics, const KinematicsCase& given)
      : kinematics_(kinematics),
        given_(given),
        n_(given.ranges.size()),
        random_(given.seed),
        answer_(n_),
        all_(kMostSolutions * n_) {}

  Checked run() {
    measure();
    for (int i = 0; i < given_.samples / kSamplesPerWay; ++i) {
      tool_ = given_.tools[static_cast<std::size_t>(i) % given_.tools.size()];
      auto fine = beyond_travel().and_then([&] { return beyond_reach(i); });
      if (fine = misdeed_or(given_.misdeed, std::move(fine)); !fine) return fine;
    }
    return {};
  }

 private:
  double random(double least, double most) { return std::uniform_real_distribution<>(least, most)(random_); }
  bool by_chance() { return random(0, 1) < 0.5; }
  /// Some that have a pose.
  void random_joints() {
    do {
      seed_.clear();
      for (const JointRange& range : given_.ranges) seed_.push_back(random(range.min, range.max));
    } while (!kinematics_.has_pose(seed_));
  }
  Vector random_direction() {
    Vector direction;
    do {
      for (double& part : direction) part = random(-1, 1);
    } while (norm(direction) < 0.1 || norm(direction) > 1);
    return unit(direction);
  }

  /// How far apart tips are within the travel.
  void measure() {
    constexpr int kPoses = 200;
    ToolPose first, other;
    for (int i = 0; i < kPoses; ++i) {
      random_joints();
      kinematics_.forward(seed_, {}, i == 0 ? first : other);
      if (i > 0) size_mm_ = std::max(size_mm_, distance(first.tip, other.tip));
    }
  }

  Checked beyond_travel() {
    constexpr double kLeast = 1e-4, kMost = 0.1;
    random_joints();
    std::vector<double> joints = seed_;
    const auto one = static_cast<std::size_t>(random(0, static_cast<double>(n_)));
    const bool all = by_chance();
    for (std::size_t j = 0; j < n_; ++j) {
      if (!all && j != std::min(one, n_ - 1)) continue;
      const JointRange& range = given_.ranges[j];
      const double by = (range.max - range.min) * std::exp(random(std::log(kLeast), std::log(kMost)));
      joints[j] = by_chance() ? range.max + by : range.min - by;
      seed_[j] = std::clamp(joints[j], range.min, range.max);
    }
    if (!kinematics_.has_pose(joints)) return {};
    kinematics_.forward(joints, tool_, pose_);
    return reached().and_then([&](bool) { return solutions_are_true(); });
  }

  /// Halves the way between a place that is reached and one that is not: wherever that leads to, places just beyond the
  /// reach are among those that were asked for.
  Checked beyond_reach(int number) {
    constexpr int kHalvings = 20;  // a millionth of the machine's size is left
    const Way way = random_way(number % 3 != 1, number % 3 != 0);
    double within = 0, beyond = 1;
    for (int i = 0; i < kHalvings; ++i) {
      const double part = i == 0 ? beyond : (within + beyond) / 2;
      pose_ = way.at(part);
      const auto there = reached();
      if (!there) return tl::unexpected(there.error());
      if (i == 0 && *there) return {};
      (*there ? within : beyond) = part;
    }
    pose_ = way.at(beyond);
    return solutions_are_true();
  }

  Way random_way(bool goes, bool tilts) {
    random_joints();
    Way way;
    kinematics_.forward(seed_, tool_, way.from);
    if (goes) way.along_mm = scaled(2 * (size_mm_ + 1), random_direction());
    if (!tilts) return way;
    Vector across;
    do {
      across = cross(way.from.axis, random_direction());
    } while (norm(across) < 0.1);
    way.tilts_to = unit(across);
    way.tilt_rad = std::numbers::pi / 2;
    return way;
  }

  /// Whether the inverse says that it reaches the pose at hand; what is wrong where it does not.
  tl::expected<bool, CounterExample> reached() {
    std::fill(answer_.begin(), answer_.end(), std::nan(""));
    if (kinematics_.inverse(pose_, tool_, seed_, answer_) != KinematicsStatus::Ok) return false;
    const auto off = miss(kinematics_, answer_, tool_, pose_, kAsWritten);
    if (off) return fault("inverse", *off, answer_);
    return true;
  }

  Checked solutions_are_true() {
    std::fill(all_.begin(), all_.end(), std::nan(""));
    const std::size_t count = kinematics_.solutions(pose_, tool_, seed_, all_);
    for (std::size_t i = 0; i < std::min(count, kMostSolutions); ++i) {
      const std::span<const double> solution(all_.data() + i * n_, n_);
      if (const auto off = miss(kinematics_, solution, tool_, pose_, kAsWritten)) {
        return fault("solutions", *off, solution);
      }
    }
    return {};
  }

  [[nodiscard]] tl::unexpected<CounterExample> fault(const char* check, const std::string& off,
                                                     std::span<const double> answer) const {
    return found(check, "it finds joints for a pose beyond its reach, and they are those of another one: " + off, -1,
                 {named_pose("pose", pose_), named_tool(tool_), named("seed", seed_), named("answer", answer)});
  }

  const Kinematics& kinematics_;
  const KinematicsCase& given_;
  std::size_t n_;
  std::mt19937_64 random_;
  double size_mm_ = 0;

  std::vector<double> seed_;  ///< of what is asked at hand, with those below
  Frame tool_;
  ToolPose pose_;
  std::vector<double> answer_, all_;
};

}  // namespace

Checked check_reach(const Kinematics& kinematics, const KinematicsCase& given) {
  return ReachCheck(kinematics, given).run();
}

}  // namespace rmac::verifier
