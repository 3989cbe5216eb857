#pragma once

#include <array>
#include <chrono>

#include "canopen/boot_plan.hpp"
#include "canopen/watch/boot_problem.hpp"
#include "canopen/watch/heartbeat_rate.hpp"
#include "canopen/watch/identity_record.hpp"
#include "canopen/watch/reset_calls.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {

/// Brings one node from wherever it is to Operational, as configured (CiA 302-2, boot-up of an NMT slave): reset of
/// its communication, boot-up message, the steps of its plan, start, first heartbeat; then it is watched for a while,
/// as it is from then on, for a second device under its id. A node that is silent after its reset may be booting, and
/// one that boots may obey resets, so that it is reset again only when it shows that it has not been: it sends
/// heartbeats, or answers what it is asked meanwhile. A question whose answer is lost is asked again. A state machine
/// without clock or socket. Real-time safe once made, so that a node that comes back is brought up by the cycle itself.
///
/// Who it is decides by which description it is treated, and so which plan is followed from there on.
///
/// A boot-up message before it is Operational begins the plan anew, its identity included: some devices send two, and
/// what decides is whether they tell two identities.
class NodeBoot {
 public:
  enum class State : std::uint8_t { Idle, AwaitingBootUp, Configuring, Starting, Proving, Operational, Failed };

  NodeBoot(const CanopenConfig& config, std::uint8_t node);

  /// From the start, whatever the node does now.
  void begin(std::chrono::nanoseconds now) noexcept;
  /// Whoever is there from now on counts as the device.
  void forget_identity() noexcept;
  /// A heartbeat, boot-up message or SDO answer of this node.
  void receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept;
  /// Its synchronous PDOs show two devices.
  void answered_twice() noexcept { fail(BootProblem::Kind::TwoAnswers); }
  /// The next frame to send, if there is one; this is where time passes.
  [[nodiscard]] bool next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  /// It answers SYNC, and what comes under its id is watched.
  [[nodiscard]] bool watched() const noexcept { return state_ == State::Proving || state_ == State::Operational; }
  [[nodiscard]] std::uint8_t node() const noexcept { return node_; }
  [[nodiscard]] const BootProblem& problem() const noexcept { return problem_; }
  /// By what it is brought up, since it told who it is: its description, and the patience with it.
  [[nodiscard]] const BootPlans::Plan& plan() const noexcept { return plans_.now(); }
  /// What it has and refused when it came up, and could do without. Off the cycle.
  [[nodiscard]] std::vector<BootProblem> notes() const;
  /// What was read of an object when it came up; 0 where it has none.
  [[nodiscard]] std::uint32_t reading(ObjectAddress object) const noexcept;
  /// The drive's error code (603Fh) when it came up.
  [[nodiscard]] std::uint16_t error_code() const noexcept { return static_cast<std::uint16_t>(reading({0x603F, 0})); }

 private:
  struct Outcome {
    std::uint32_t reading = 0;  ///< 0 where the step reads nothing
    std::uint32_t refusal = 0;  ///< its abort code; 0 where it was not refused
    /// Of a comparison: it differs. Of storing: once, lest a drive that keeps nothing has its memory worn out.
    bool done = false;
  };

  /// What became of the step in hand.
  struct Question {
    int tries = 0;              ///< unanswered
    std::uint32_t refused = 0;  ///< the abort code of its writing, while it is read what is there already
  };

  /// A step of the plan so far had this kind, and it came to something.
  [[nodiscard]] bool done(BootStep::Kind kind) const noexcept;
  [[nodiscard]] bool left_out(std::size_t step) const noexcept;
  void enter(State state, std::chrono::nanoseconds now) noexcept;
  void configure(std::chrono::nanoseconds now) noexcept;
  void take_heartbeat(NmtState said, std::chrono::nanoseconds now) noexcept;
  void fail(BootProblem::Kind kind, std::uint32_t found = 0) noexcept;
  /// A reset, where it is due, or a question whether the node is there.
  [[nodiscard]] bool call(std::chrono::nanoseconds now, CanFrame& frame) noexcept;
  void begin_step(std::chrono::nanoseconds now) noexcept;
  /// A comparison is over: true, or it failed.
  [[nodiscard]] bool compared(const BootStep& step) noexcept;
  void ask(std::chrono::nanoseconds now) noexcept;
  [[nodiscard]] bool refuses_for_now(std::chrono::nanoseconds now) const noexcept;
  [[nodiscard]] bool asks_again(std::chrono::nanoseconds now) noexcept;
  /// What is not needed was not answered: it is asked whether it answers at all.
  [[nodiscard]] bool doubted() const noexcept;
  void end_step(std::chrono::nanoseconds now) noexcept;
  [[nodiscard]] BootProblem problem_of(const BootStep& step) const noexcept;
  [[nodiscard]] bool passes() noexcept;

  std::uint8_t node_;
  std::chrono::nanoseconds proving_;  ///< how long
  std::chrono::nanoseconds echo_;     ///< so soon behind another, a heartbeat is a copy
  BootPlans plans_;
  std::vector<Outcome> outcomes_;  ///< one a step
  SdoClient sdo_;
  IdentityRecord identity_;
  HeartbeatRate heartbeats_;
  ResetCalls resets_;
  State state_ = State::Idle;
  int restarts_ = 0;  ///< since `begin`
  BootProblem problem_;
  std::size_t step_ = 0;
  Question question_;
  bool answered_ = false;   ///< an SDO, since its boot-up message
  bool held_back_ = false;  ///< it was told to wait in Pre-operational while it is set up
  std::array<std::uint8_t, 8> bytes_{};
  std::chrono::nanoseconds entered_{0};
  std::chrono::nanoseconds next_{0};  ///< when it is started or asked again
};

}  // namespace rmac::fieldbus::canopen
