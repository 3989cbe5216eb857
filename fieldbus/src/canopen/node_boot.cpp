#include "canopen/node_boot.hpp"

#include <algorithm>
#include <utility>

namespace rmac::fieldbus::canopen {
namespace {

// A node may miss its start.
constexpr std::chrono::seconds kBetweenStarts{1};

// One that has just sent its boot-up message may refuse things for a while.
constexpr std::chrono::seconds kReadyWithin{2};
constexpr std::chrono::milliseconds kBetweenQuestions{100};

// Drives erase and write whole pages of flash.
constexpr std::chrono::seconds kTimeToStore{10};

// Device type: each node tells it.
constexpr ObjectAddress kAlwaysThere{0x1000, 0};

// A node that starts anew more often than this while it is set up will not come up.
constexpr int kMostRestarts = 8;

// Two devices show within it, by SYNCs they answer or by heartbeats.
constexpr int kProvingHeartbeats = 4;
constexpr int kProvingSyncs = 20;

}  // namespace

NodeBoot::NodeBoot(const CanopenConfig& config, std::uint8_t node)
    : node_(node),
      proving_(
          std::max<std::chrono::nanoseconds>(kProvingHeartbeats * config.heartbeat, kProvingSyncs * config.period)),
      echo_(2 * config.period),
      plans_(config, node),
      outcomes_(plans_.longest()),
      sdo_(node) {}

void NodeBoot::forget_identity() noexcept {
  identity_.forget();
  plans_.forget();
  for (Outcome& outcome : outcomes_) outcome.done = false;
}

std::uint32_t NodeBoot::reading(ObjectAddress object) const noexcept {
  const std::vector<BootStep>& steps = plan().steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].kind == BootStep::Kind::Read && steps[i].object == object) return outcomes_[i].reading;
  }
  return 0;
}

std::vector<BootProblem> NodeBoot::notes() const {
  std::vector<BootProblem> notes;
  const std::vector<BootStep>& steps = plan().steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const std::uint32_t code = outcomes_[i].refusal;
    const auto kind = steps[i].may_be_constant ? BootProblem::Kind::Constant : BootProblem::Kind::Refused;
    // Entries of one mapping are one matter.
    const auto known = [&](const BootProblem& note) {
      const bool same = kind == BootProblem::Kind::Constant ? note.object.index == steps[i].object.index
                                                            : note.object == steps[i].object;
      return same && note.kind == kind;
    };
    if (code == 0 || code == sdo_abort::kNoObject || code == sdo_abort::kNoSubindex) continue;
    if (std::any_of(notes.begin(), notes.end(), known)) continue;
    notes.push_back(problem_of(steps[i]));
    notes.back().kind = kind;
    notes.back().found = code;
  }
  return notes;
}

void NodeBoot::enter(State state, std::chrono::nanoseconds now) noexcept {
  state_ = state;
  entered_ = now;
  next_ = now;
}

void NodeBoot::begin(std::chrono::nanoseconds now) noexcept {
  problem_ = {};
  restarts_ = 0;
  resets_.restart(now);
  enter(State::AwaitingBootUp, now);
}

void NodeBoot::configure(std::chrono::nanoseconds now) noexcept {
  sdo_.abandon();
  step_ = 0;
  for (std::size_t i = 0; i < plan().steps.size(); ++i) {
    if (plan().steps[i].kind == BootStep::Kind::Compare) outcomes_[i].done = false;
  }
  answered_ = false;
  held_back_ = false;
  enter(State::Configuring, now);
  begin_step(now);
}

void NodeBoot::fail(BootProblem::Kind kind, std::uint32_t found) noexcept {
  problem_.kind = kind;
  problem_.found = found;
  problem_.waited = plan().patience.boot_timeout;
  problem_.drive = plan().drive;
  state_ = State::Failed;
}

void NodeBoot::receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept {
  if (state_ == State::AwaitingBootUp) resets_.heard(now);
  if (frame.id == kSdoAnswerId + node_) {
    answered_ = true;
    if (const auto contradiction = identity_.take(frame); contradiction && state_ != State::Idle) {
      problem_ = {.object = contradiction->object, .expected = contradiction->first};
      return fail(BootProblem::Kind::TwoIdentities, contradiction->second);
    }
    return sdo_.receive(frame, now);
  }
  if (frame.id == kHeartbeatId + node_ && frame.size == 1) take_heartbeat(heartbeat_state(frame), now);
}

void NodeBoot::take_heartbeat(NmtState said, std::chrono::nanoseconds now) noexcept {
  if (said == NmtState::BootUp) {
    // Also in the middle of it: a node that starts anew has forgotten what it was told.
    if (state_ == State::Operational) return fail(BootProblem::Kind::Restarted);
    if (state_ == State::Idle || state_ == State::Failed) return;
    if (restarts_++ > kMostRestarts) return fail(BootProblem::Kind::Restarts);
    return configure(now);
  }
  if (watched() && heartbeats_.take(now)) return fail(BootProblem::Kind::TwoHeartbeats);
  if (said != NmtState::Operational && state_ == State::Proving) {
    if (restarts_++ > kMostRestarts) return fail(BootProblem::Kind::Restarts);
    return enter(State::Starting, now);
  }
  if (said == NmtState::Operational && state_ == State::Starting) {
    enter(State::Proving, now);
    heartbeats_.restart(now, std::chrono::milliseconds(reading({0x1017, 0})), echo_);
  }
}

BootProblem NodeBoot::problem_of(const BootStep& step) const noexcept {
  const bool writing = step.kind == BootStep::Kind::Write || step.kind == BootStep::Kind::Store;
  // `value` of a write is what may be there already.
  BootProblem problem{
      .object = step.object, .expected = writing ? 0 : step.value, .writing = writing, .needed = step.needed};
  for (std::size_t i = 0; problem.writing && i < step.bytes.size() && i < 4; ++i) {
    problem.expected |= static_cast<std::uint32_t>(step.bytes[i]) << (8 * i);
  }
  return problem;
}

bool NodeBoot::done(BootStep::Kind kind) const noexcept {
  const std::vector<BootStep>& steps = plan().steps;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (steps[i].kind == kind && outcomes_[i].done) return true;
  }
  return false;
}

bool NodeBoot::left_out(std::size_t step) const noexcept {
  const BootStep& one = plan().steps[step];
  return (one.after_refusal && outcomes_[step - 1].refusal == 0) ||
         (one.after_change && !done(BootStep::Kind::Compare));
}

void NodeBoot::begin_step(std::chrono::nanoseconds now) noexcept {
  if (step_ == kIdentitySteps) plans_.choose(identity_.identity());
  const std::vector<BootStep>& steps = plan().steps;
  while (step_ < steps.size() && left_out(step_)) outcomes_[step_++].refusal = 0;
  if (step_ == steps.size()) return enter(State::Starting, now);
  const BootStep& step = steps[step_];
  problem_ = problem_of(step);
  outcomes_[step_].refusal = 0;
  question_ = {};
  if (step.kind == BootStep::Kind::Refuse) return fail(BootProblem::Kind::Unfit);
  if (step.kind == BootStep::Kind::Reset) {
    resets_.restart(now);
    return enter(State::AwaitingBootUp, now);
  }
  sdo_.set_timeout(step.kind == BootStep::Kind::Store ? std::chrono::nanoseconds(kTimeToStore)
                                                      : plan().patience.sdo_timeout);
  ask(now);
}

void NodeBoot::ask(std::chrono::nanoseconds now) noexcept {
  const BootStep& step = plan().steps[step_];
  if (doubted()) {
    sdo_.upload(kAlwaysThere, bytes_, now);
  } else if (problem_.writing && question_.refused == 0) {
    sdo_.download(step.object, step.bytes, now);
  } else {
    bytes_.fill(0);
    sdo_.upload(step.object, bytes_, now);
  }
}

/// One that has just sent its boot-up message may not be ready to answer; afterwards a few tries are enough.
bool NodeBoot::asks_again(std::chrono::nanoseconds now) noexcept {
  const bool timed_out = sdo_.state() == SdoClient::State::Refused && sdo_.abort_code() == sdo_abort::kTimeout;
  if (sdo_.state() != SdoClient::State::Failed && !timed_out) return false;
  if (!answered_) return now - entered_ < plan().patience.boot_timeout;
  const int most = plan().patience.sdo_tries;
  return ++question_.tries < most || (doubted() && question_.tries < 2 * most);
}

bool NodeBoot::refuses_for_now(std::chrono::nanoseconds now) const noexcept {
  if (sdo_.state() != SdoClient::State::Refused || now - entered_ >= kReadyWithin) return false;
  return sdo_.abort_code() == sdo_abort::kPresentState || sdo_.abort_code() == sdo_abort::kNoResource;
}

bool NodeBoot::doubted() const noexcept {
  const BootStep& step = plan().steps[step_];
  return step.optional && step.kind != BootStep::Kind::Compare && question_.tries >= plan().patience.sdo_tries;
}

bool NodeBoot::compared(const BootStep& step) noexcept {
  const bool read = sdo_.state() == SdoClient::State::Done;
  const std::uint32_t found = read ? long_at(bytes_.data()) : 0;
  outcomes_[step_].done = !read || (found & step.mask) != step.value;
  if (!outcomes_[step_].done || !done(BootStep::Kind::Store)) return true;
  problem_.needed = "to be kept, and was not though it was stored (StoreAfterMapping)";
  fail(BootProblem::Kind::Different, found);
  return false;
}

bool NodeBoot::passes() noexcept {
  const BootStep& step = plan().steps[step_];
  if (question_.refused != 0) {
    const bool read = sdo_.state() == SdoClient::State::Done;
    if (read) problem_.kept = long_at(bytes_.data());
    outcomes_[step_].refusal = question_.refused;
    const bool constant = read && (*problem_.kept & step.mask) == step.value;
    if (!constant) fail(BootProblem::Kind::Refused, question_.refused);
    return constant;
  }
  if (step.kind == BootStep::Kind::Compare && sdo_.state() != SdoClient::State::Failed) return compared(step);
  if (step.kind == BootStep::Kind::Read) outcomes_[step_].reading = 0;
  if (doubted() && sdo_.state() != SdoClient::State::Failed) {
    outcomes_[step_].refusal = sdo_abort::kTimeout;
    return true;
  }
  if (sdo_.state() == SdoClient::State::Refused) {
    const std::uint32_t code = sdo_.abort_code();
    outcomes_[step_].refusal = code;
    const bool absent = code == sdo_abort::kNoObject || code == sdo_abort::kNoSubindex;
    const bool passed_over = step.optional || (step.may_be_absent && absent);
    if (!passed_over) fail(BootProblem::Kind::Refused, code);
    return passed_over;
  }
  if (sdo_.state() != SdoClient::State::Done) {
    outcomes_[step_].refusal = sdo_.abort_code();
    if (step.optional && sdo_.abort_code() != sdo_abort::kTimeout) return true;  // what it answers is not understood
    fail(BootProblem::Kind::NoAnswer, sdo_.abort_code());
    return false;
  }
  const std::uint32_t found = long_at(bytes_.data());
  if (step.kind == BootStep::Kind::Read) outcomes_[step_].reading = found;
  if (step.kind == BootStep::Kind::Store) outcomes_[step_].done = true;
  if (step.kind == BootStep::Kind::Check && (found & step.mask) != step.value) {
    fail(BootProblem::Kind::Different, found);
    return false;
  }
  return true;
}

void NodeBoot::end_step(std::chrono::nanoseconds now) noexcept {
  if (sdo_.state() == SdoClient::State::Idle) {  // refused for now
    if (now >= next_) ask(now);
    return;
  }
  if (refuses_for_now(now)) {
    sdo_.abandon();
    next_ = now + kBetweenQuestions;
    return;
  }
  if (asks_again(now)) return ask(now);
  if (plan().steps[step_].may_be_constant && question_.refused == 0 && sdo_.state() == SdoClient::State::Refused) {
    question_ = {.refused = sdo_.abort_code()};
    return ask(now);
  }
  if (!passes()) return;
  ++step_;
  begin_step(now);
}

bool NodeBoot::call(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (resets_.due(now)) {
    sdo_.abandon();
    frame = nmt_frame(NmtCommand::ResetCommunication, node_);
    return true;
  }
  if (!resets_.asks(now)) return false;
  if (sdo_.finished()) sdo_.upload(kAlwaysThere, bytes_, now);
  return sdo_.next_frame(now, frame);
}

bool NodeBoot::next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept {
  if (state_ == State::Configuring) {
    if (!std::exchange(held_back_, true)) {
      // One that starts by itself may take the parameters of its PDOs in Pre-operational only.
      frame = nmt_frame(NmtCommand::EnterPreOperational, node_);
      return true;
    }
    if (sdo_.finished()) end_step(now);
    if (state_ == State::Configuring) return sdo_.next_frame(now, frame);
  }
  if (state_ == State::Proving && now - entered_ >= proving_) state_ = State::Operational;
  const bool commands = state_ == State::AwaitingBootUp || state_ == State::Starting;
  if (!commands) return false;
  if (now - entered_ >= plan().patience.boot_timeout) {
    fail(state_ == State::Starting ? BootProblem::Kind::NoStart : BootProblem::Kind::NoBootUp);
    return false;
  }
  if (state_ == State::AwaitingBootUp) return call(now, frame);
  if (now < next_) return false;
  next_ = now + kBetweenStarts;
  frame = nmt_frame(NmtCommand::Start, node_);
  return true;
}

}  // namespace rmac::fieldbus::canopen
