#include <chrono>
#include <cmath>
#include <numbers>

#include "gateway/verifier/trap.hpp"
#include "rmac/modules/feedforward_feedback_servo_law.hpp"
#include "rmac/modules/proportional_transmissions.hpp"
#include "rmac/modules/transmission_map.hpp"
#include "rmac/motion/frame.hpp"
#include "rmac/motion/servo/learned_path.hpp"
#include "rmac/motion/servo/servo_command.hpp"
#include "rmac/motion/servo/servo_loop.hpp"
#include "rmac/motion/servo/servo_loop_parts.hpp"
#include "rmac/motion/servo/servo_report.hpp"
#include "rows.hpp"

namespace rmac::bench {
namespace {

/// An arm of turning joints, axes crossed and parallel by turns: forward kinematics and Jacobian as a six-axis machine
/// has them, link by link.
class Arm final : public Kinematics {
 public:
  explicit Arm(std::size_t joints) : joints_(joints) {}
  [[nodiscard]] std::size_t joint_count() const noexcept override { return joints_; }
  [[nodiscard]] JointType joint_type(std::size_t) const noexcept override { return JointType::Rotary; }

  void forward(std::span<const double> joints, const Frame& tool, ToolPose& pose) const noexcept override {
    Links links;
    pose = follow(joints, tool, links);
  }
  [[nodiscard]] KinematicsStatus inverse(const ToolPose&, const Frame&, std::span<const double>,
                                         std::span<double>) const noexcept override {
    return KinematicsStatus::OutOfReach;  // the servo loop does not ask
  }
  void jacobian(std::span<const double> joints, const Frame& tool, std::span<double> jacobian) const noexcept override {
    Links links;
    const ToolPose pose = follow(joints, tool, links);
    for (std::size_t j = 0; j < joints_; ++j) {
      const Vector arm{pose.tip[0] - links[j].origin[0], pose.tip[1] - links[j].origin[1],
                       pose.tip[2] - links[j].origin[2]};
      const Vector tip = cross(links[j].axis, arm);
      const Vector axis = cross(links[j].axis, pose.axis);
      for (std::size_t row = 0; row < 3; ++row) {
        jacobian[row * joints_ + j] = tip[row] * modules::kRadPerDegree;
        jacobian[(row + 3) * joints_ + j] = axis[row] * modules::kRadPerDegree;
      }
    }
  }

 private:
  struct Link {
    Vector origin, axis;
  };
  using Links = std::array<Link, kMaxJoints>;

  static Vector cross(const Vector& a, const Vector& b) noexcept {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  ToolPose follow(std::span<const double> joints, const Frame& tool, Links& links) const noexcept {
    Frame at;
    for (std::size_t j = 0; j < joints_; ++j) {
      const double half = joints[j] * modules::kRadPerDegree / 2;
      const double c = std::cos(half), s = std::sin(half);
      const Frame turn = j % 3 == 0 ? Frame{{0, 0, 100}, {c, 0, 0, s}} : Frame{{0, 0, 100}, {c, 0, s, 0}};
      const Vector across = apply_to_vector(at, {0, 1, 0});
      links[j] = {at.p, j % 3 == 0 ? z_axis(at) : across};
      at = compose(at, turn);
    }
    const Frame tip = compose(at, tool);
    return {tip.p, z_axis(tip)};
  }
  std::size_t joints_;
};

/// Drives that are operational at once, stand wherever they are put, and tell where their loads are.
class InstantBus final : public DigitalControlInterface {
 public:
  explicit InstantBus(std::size_t axes) : words(axes) {}
  [[nodiscard]] std::size_t axis_count() const noexcept override { return words.size(); }
  [[nodiscard]] Expected<> start() override { return {}; }
  void stop() noexcept override {}
  [[nodiscard]] bool receive(std::span<DriveFeedback> feedback) noexcept override {
    std::copy(words.begin(), words.end(), feedback.begin());
    return true;
  }
  [[nodiscard]] bool send(std::span<const DriveCommand> commands) noexcept override {
    for (const DriveCommand& command : commands) torques += std::abs(command.target_torque_permille);
    return true;
  }
  [[nodiscard]] bool tells_load(std::size_t /*axis*/) const noexcept override { return true; }
  std::vector<DriveFeedback> words;
  std::int64_t torques = 0;  ///< of all commands, per mille
};

constexpr double kStep_mm = 0.1;  // along the path in a cycle

/// Offsets of one move of so many cycles, a knot each 20.
std::shared_ptr<const LearnedPath> learned_path(std::size_t joints, int cycles) {
  LearnedPath::Parts parts{{{1, 0}}, kStep_mm * cycles, {}, joints, {}};
  for (int i = 0; i <= cycles; i += 20) {
    parts.places.push_back(kStep_mm * i);
    for (std::size_t j = 0; j < joints; ++j)
      parts.offsets.push_back(0.01 * std::sin(0.02 * i + static_cast<double>(j)));
  }
  return std::make_shared<const LearnedPath>(*LearnedPath::create(std::move(parts)));
}

/// As many harmonics as `rmac tune --creep` finds at most.
Cogging cogging() {
  Cogging known{{}, 0.0017};
  for (const int order : {12, 24, 36, 6, 60, 84}) known.harmonics.push_back({order, 0.001, 0.002});
  return known;
}

struct Cycles {
  std::vector<double> microseconds;
  verifier::TrapCounts trapped;
  bool followed = false;
  std::int64_t torques = 0;
};

/// With `more`, cogging is known and friction before it slides, and offsets were learned.
Cycles run_cycles(std::size_t joints, int count, bool more = false) {
  const auto simulated = std::make_shared<InstantBus>(joints);
  for (DriveFeedback& words : simulated->words) words = {.statusword = 0x27, .online = true};
  const auto bus = std::make_shared<ServoBus>(simulated);
  constexpr double kCountsPerTurn = 131072, kGear = 50;
  ServoLoopParts parts;
  parts.kinematics = std::make_shared<Arm>(joints);
  std::vector<std::unique_ptr<ActuatorMap>> gears;
  modules::FeedforwardModel::Parameters friction;
  if (more) friction = {.presliding = 0.01, .breakaway = 1.2};
  for (std::size_t j = 0; j < joints; ++j) {
    gears.push_back(std::make_unique<modules::Proportional>(modules::Proportional::gear(kGear)));
    auto law =
        std::make_shared<modules::FeedforwardFeedbackServoLaw>(modules::ErrorSignal::Parameters{0.001, 0}, friction);
    (void)law->set_gains(std::array{50.0, 500.0, 0.5, 0.1, 0.01, 2.0, 0.0});
    parts.joints.push_back({law, ControlMethod::Position, 5, 500});
    parts.actuators.push_back({bus, static_cast<std::uint32_t>(j), {kCountsPerTurn, 1, 1, 0}});
    if (more) parts.actuators.back().cogging = cogging();
  }
  parts.actuator_map = std::make_shared<modules::TransmissionMap>(std::move(gears));
  auto loop = std::move(*ServoLoop::create(std::move(parts)));

  if (more) {
    auto learned = learned_path(joints, count);
    loop->exchange_learned(learned);
  }

  ServoCommand command;
  command.power = true;
  command.program = true;
  command.setpoint.move_id = 1;
  command.setpoint.moving = true;
  ServoReport report;
  for (int i = 0; i < 10; ++i) loop->cycle(command, report);
  Cycles result;
  result.followed = true;
  result.microseconds.reserve(static_cast<std::size_t>(count));
  (void)verifier::prepare_trap();
  (void)verifier::take_trap_counts();
  for (int i = 0; i < count; ++i) {
    for (std::size_t j = 0; j < joints; ++j) {
      // A swing of 20 degrees a joint; the drives stand where they were to be a cycle ago.
      const double w = 2 + 0.3 * static_cast<double>(j);
      simulated->words[j].position_counts =
          static_cast<std::int32_t>(command.setpoint.position[j] * kGear / 360 * kCountsPerTurn);
      const double phase = w * 1e-3 * i;
      command.setpoint.position[j] = 20 * std::sin(phase);
      command.setpoint.velocity[j] = 20 * w * std::cos(phase);
      command.setpoint.acceleration[j] = -20 * w * w * std::sin(phase);
    }
    command.setpoint.s_mm = kStep_mm * i;
    // Every tenth cycle under the trap; its arming is no part of the time.
    const bool trapped = i % 10 == 0;
    if (trapped) verifier::arm_trap();
    const auto began = std::chrono::steady_clock::now();
    loop->cycle(command, report);
    const auto ended = std::chrono::steady_clock::now();
    if (trapped) verifier::disarm_trap();
    result.followed = result.followed && report.follows;
    result.microseconds.push_back(std::chrono::duration<double, std::micro>(ended - began).count());
  }
  result.torques = simulated->torques;
  result.trapped = verifier::take_trap_counts();
  return result;
}

}  // namespace

void cycle_rows(Figures& figures) {
  constexpr int kCycles = 200'000;
  const Cycles six = run_cycles(6, kCycles);
  const Cycles many = run_cycles(32, kCycles);
  const char* const note = "arm kinematics, gears, feedforward with feedback; a shared machine's clock";
  const Cycles more = run_cycles(6, kCycles, true);
  const auto of_all = [&](auto count) {
    return static_cast<double>(six.trapped.*count + many.trapped.*count + more.trapped.*count);
  };
  if (!six.followed || !many.followed || !more.followed) {
    figures.missing("cycle_6_joints_p50", "<= 2", "us", "the loop did not follow its setpoints");
    return;
  }
  if (more.torques == six.torques) {
    figures.missing("cycle_6_joints_cogging_and_learned_p50", "<= 2", "us", "what is known changes no torque");
    return;
  }
  const double median = quantile(six.microseconds, 0.5);
  figures.at_most("cycle_6_joints_p50", median, 2, "us", note);
  figures.at_most("cycle_6_joints_p99_9", quantile(six.microseconds, 0.999), 5, "us", note);
  figures.at_most("cycle_6_joints_cogging_and_learned_p50", quantile(more.microseconds, 0.5), 2, "us",
                  "six harmonics of cogging a motor, friction before it slides, and learned offsets in force");
  figures.at_most("cycle_32_joints_over_6_joints_p50", quantile(many.microseconds, 0.5) / median, 6, "times", note);
  figures.at_most("cycle_allocations", of_all(&verifier::TrapCounts::allocations), 0, "calls",
                  "every tenth cycle under the trap");
  figures.at_most("cycle_locks", of_all(&verifier::TrapCounts::locks), 0, "calls");
  figures.at_most("cycle_system_calls", of_all(&verifier::TrapCounts::system_calls), 0, "calls");
}

}  // namespace rmac::bench
