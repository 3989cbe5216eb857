#pragma once

#include <array>
#include <chrono>
#include <string>

#include "canopen/boot_plan.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"
#include "rmac/fieldbus/canopen/sdo_client.hpp"

namespace rmac::fieldbus::canopen {

/// Why a node did not come up.
struct BootProblem {
  enum class Kind : std::uint8_t {
    None,
    NoBootUp,   ///< it never spoke
    NoAnswer,   ///< it spoke, but did not answer for `object`
    Refused,    ///< it refused `object`; `found` is its abort code
    Different,  ///< `object` is `found` where `expected` was
    NoStart,    ///< it is set up, and does not become operational
  };
  Kind kind = Kind::None;
  ObjectAddress object;
  std::uint32_t expected = 0;
  std::uint32_t found = 0;
  bool writing = false;
};

/// Brings one node from wherever it is to Operational, as configured (CiA 302-2, boot-up of an NMT slave): reset of
/// its communication, boot-up message, the steps of its plan, start, first heartbeat. A state machine without clock or
/// socket. Real-time safe once made, so that a node that comes back is brought up by the cycle itself.
class NodeBoot {
 public:
  enum class State : std::uint8_t { Idle, AwaitingBootUp, Configuring, Starting, Operational, Failed };

  NodeBoot(const CanopenConfig& config, std::uint8_t node);

  /// From the start, whatever the node does now.
  void begin(std::chrono::nanoseconds now) noexcept;
  /// A heartbeat, boot-up message or SDO answer of this node.
  void receive(const CanFrame& frame, std::chrono::nanoseconds now) noexcept;
  /// The next frame to send, if there is one; this is where time passes.
  [[nodiscard]] bool next_frame(std::chrono::nanoseconds now, CanFrame& frame) noexcept;

  [[nodiscard]] State state() const noexcept { return state_; }
  [[nodiscard]] std::uint8_t node() const noexcept { return node_; }
  [[nodiscard]] const BootProblem& problem() const noexcept { return problem_; }
  /// What was read of an object when it came up; 0 where it has none.
  [[nodiscard]] std::uint32_t reading(ObjectAddress object) const noexcept;
  /// The drive's error code (603Fh) when it came up.
  [[nodiscard]] std::uint16_t error_code() const noexcept { return static_cast<std::uint16_t>(reading({0x603F, 0})); }

 private:
  void enter(State state, std::chrono::nanoseconds now) noexcept;
  void fail(BootProblem::Kind kind, std::uint32_t found = 0) noexcept;
  void begin_step(std::chrono::nanoseconds now) noexcept;
  void end_step(std::chrono::nanoseconds now) noexcept;
  [[nodiscard]] bool passes() noexcept;

  std::uint8_t node_;
  std::chrono::nanoseconds timeout_;
  std::vector<BootStep> steps_;
  std::vector<std::uint32_t> readings_;  ///< one a step; 0 where the step reads nothing
  SdoClient sdo_;
  State state_ = State::Idle;
  BootProblem problem_;
  std::size_t step_ = 0;
  std::array<std::uint8_t, 8> bytes_{};
  std::chrono::nanoseconds entered_{0};
  std::chrono::nanoseconds next_command_{0};
};

/// What went wrong and what to do, for a person.
[[nodiscard]] std::string describe(const BootProblem& problem, std::uint8_t node, const CanopenConfig& config);

}  // namespace rmac::fieldbus::canopen
