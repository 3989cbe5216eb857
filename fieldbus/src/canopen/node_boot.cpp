#include "canopen/node_boot.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace rmac::fieldbus::canopen {
namespace {

// A node may miss a command while it starts up; asked too often it would never be ready.
constexpr std::chrono::seconds kCommandInterval{1};

/// The index of the same object of a node's first axis.
std::uint16_t object_of_first_axis(std::uint16_t index) noexcept {
  if (index < kFirstProfileObject) return index;
  return static_cast<std::uint16_t>(kFirstProfileObject + (index - kFirstProfileObject) % kAxisOffset);
}

/// Modes of operation by their numbers (CiA 402-2, 6060h).
constexpr std::array kModeNames{"",
                                "profile position",
                                "velocity",
                                "profile velocity",
                                "profile torque",
                                "",
                                "homing",
                                "interpolated position",
                                "cyclic synchronous position",
                                "cyclic synchronous velocity",
                                "cyclic synchronous torque"};

/// Tells that a drive's supported modes (6502h, bit 0 is mode 1) lack one that it is to run in.
std::string cannot_do(const BootProblem& problem, const std::string& object) {
  std::string wanted, there;
  for (unsigned mode = 1; mode < kModeNames.size(); ++mode) {
    const std::uint32_t bit = 1U << (mode - 1);
    if ((problem.expected & ~problem.found & bit) != 0) {
      wanted += fmt::format("{}{} (mode {})", wanted.empty() ? "" : " and ", kModeNames.at(mode), mode);
    }
    if ((problem.found & bit) != 0) there += fmt::format("{}{}", there.empty() ? "" : ", ", mode);
  }
  return fmt::format(" cannot do {}: {} says that it does the modes {}", wanted, object,
                     there.empty() ? "of its maker only" : there);
}

}  // namespace

NodeBoot::NodeBoot(const CanopenConfig& config, std::uint8_t node)
    : node_(node),
      timeout_(config.boot_timeout),
      steps_(boot_plan(config, node)),
      readings_(steps_.size()),
      sdo_(node) {}

std::uint32_t NodeBoot::reading(ObjectAddress object) const noexcept {
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    if (steps_[i].kind == BootStep::Kind::Read && steps_[i].object == object) return readings_[i];
  }
  return 0;
}

void NodeBoot::enter(State state, std::chrono::nanoseconds now) noexcept {
  state_ = state;
  entered_ = now;
  next_command_ = now;
}

void NodeBoot::begin(std::chrono::nanoseconds now) noexcept {
  problem_ = {};
  sdo_ = SdoClient(node_);
  enter(State::AwaitingBootUp, now);
}

void NodeBoot::fail(BootProblem::Kind kind, std::uint32_t found) noexcept {
  problem_.kind = kind;
  problem_.found = found;
  state_ = State::Failed;
}

void NodeBoot::receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  if (frame.id == kSdoAnswerId + node_) {
    sdo_.receive(frame, now);
    return;
  }
  if (frame.id != kHeartbeatId + node_ || frame.size != 1) return;
  const NmtState said = heartbeat_state(frame);
  if (said == NmtState::BootUp) {
    // Also in the middle of it: a node that starts anew has forgotten what it was told.
    const bool on_its_way =
        state_ == State::AwaitingBootUp || state_ == State::Configuring || state_ == State::Starting;
    if (!on_its_way) return;
    sdo_ = SdoClient(node_);
    step_ = 0;
    enter(State::Configuring, now);
    begin_step(now);
  } else if (said == NmtState::Operational && state_ == State::Starting) {
    state_ = State::Operational;
  }
}

void NodeBoot::begin_step(std::chrono::nanoseconds now) noexcept {
  if (step_ == steps_.size()) return enter(State::Starting, now);
  const BootStep& step = steps_[step_];
  problem_ = {.object = step.object, .expected = step.value, .writing = step.kind == BootStep::Kind::Write};
  if (problem_.writing) {
    for (std::size_t i = 0; i < step.bytes.size() && i < 4; ++i) {
      problem_.expected |= static_cast<std::uint32_t>(step.bytes[i]) << (8 * i);
    }
    sdo_.download(step.object, step.bytes, now);
  } else {
    bytes_.fill(0);
    sdo_.upload(step.object, bytes_, now);
  }
}

bool NodeBoot::passes() noexcept {
  const BootStep& step = steps_[step_];
  if (step.kind == BootStep::Kind::Read) readings_[step_] = 0;
  if (sdo_.state() == SdoClient::State::Refused) {
    const std::uint32_t code = sdo_.abort_code();
    const bool absent = code == sdo_abort::kNoObject || code == sdo_abort::kNoSubindex;
    if (!step.optional || !absent) fail(BootProblem::Kind::Refused, code);
    return step.optional && absent;
  }
  if (sdo_.state() != SdoClient::State::Done) {
    fail(BootProblem::Kind::NoAnswer, sdo_.abort_code());
    return false;
  }
  const std::uint32_t found = long_at(bytes_.data());
  if (step.kind == BootStep::Kind::Read) readings_[step_] = found;
  if (step.kind == BootStep::Kind::Check && (found & step.mask) != step.value) {
    fail(BootProblem::Kind::Different, found);
    return false;
  }
  return true;
}

void NodeBoot::end_step(std::chrono::nanoseconds now) noexcept {
  if (!passes()) return;
  ++step_;
  begin_step(now);
}

bool NodeBoot::next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (state_ == State::Configuring) {
    if (sdo_.finished()) end_step(now);
    if (state_ == State::Configuring) return sdo_.next_frame(now, frame);
  }
  const bool commands = state_ == State::AwaitingBootUp || state_ == State::Starting;
  if (!commands) return false;
  if (now - entered_ >= timeout_) {
    fail(state_ == State::Starting ? BootProblem::Kind::NoStart : BootProblem::Kind::NoBootUp);
    return false;
  }
  if (now < next_command_) return false;
  next_command_ = now + kCommandInterval;
  frame = nmt_frame(state_ == State::Starting ? NmtCommand::Start : NmtCommand::ResetCommunication, node_);
  return true;
}

std::string describe(const BootProblem& problem, std::uint8_t node, const CanopenConfig& config) {
  std::string axes;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    if (config.axes[i].node == node) axes += fmt::format("{}{}", axes.empty() ? "" : ", ", i);
  }
  const std::string who = fmt::format("node {} (axis {})", node, axes);
  const double waited_s = std::chrono::duration<double>(config.boot_timeout).count();
  const std::string object = to_string(problem.object);
  switch (problem.kind) {
    case BootProblem::Kind::None:
      return who + " came up";
    case BootProblem::Kind::NoBootUp:
      return fmt::format(
          "{} is missing: no boot-up message in {:g} s; check its power, its cable, its node id, and that it is set to "
          "{} bit/s",
          who, waited_s, config.bit_rate);
    case BootProblem::Kind::NoAnswer:
      return fmt::format("{} did not answer when {} was {}: {}", who, object, problem.writing ? "written" : "read",
                         sdo_abort_text(problem.found));
    case BootProblem::Kind::Refused:
      return problem.writing ? fmt::format("{} refused {:X}h for {}: {} ({:08X}h)", who, problem.expected, object,
                                           sdo_abort_text(problem.found), problem.found)
                             : fmt::format("{} refused to tell {}: {} ({:08X}h)", who, object,
                                           sdo_abort_text(problem.found), problem.found);
    case BootProblem::Kind::Different:
      if (problem.object.index == 0x1000) {
        return fmt::format("{} is not a drive: its device type (1000h) is {:08X}h, and a CiA 402 drive ends in 0192h",
                           who, problem.found);
      }
      if (problem.object.index == 0x1018) {
        constexpr std::array kNames{"", "vendor id", "product code", "revision number", "serial number"};
        return fmt::format("{} is another device than configured: its {} ({}) is {:X}h, not {:X}h", who,
                           kNames.at(problem.object.sub), object, problem.found, problem.expected);
      }
      if (object_of_first_axis(problem.object.index) == 0x6502) return who + cannot_do(problem, object);
      if (object_of_first_axis(problem.object.index) == 0x607E) {
        return fmt::format(
            "{} turns its positions round ({} is {:X}h), and follows torques, so it could run away; set polarity to 0 "
            "and the actuator's Direction to -1, or polarity to {} where the drive turns its torques round, too",
            who, object, problem.found, problem.found & 0xFFU);
      }
      return fmt::format("{} does not support what is asked of it: {} is {:X}h, and {:X}h is needed in it", who, object,
                         problem.found, problem.expected);
    case BootProblem::Kind::NoStart:
      return fmt::format("{} is set up, but did not become operational in {:g} s", who, waited_s);
  }
  return who;
}

}  // namespace rmac::fieldbus::canopen
