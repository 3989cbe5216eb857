#include "canopen/watch/boot_problem.hpp"

#include <fmt/format.h>

#include <array>

#include "canopen/objects/standard_objects.hpp"
#include "rmac/fieldbus/canopen/emergency.hpp"
#include "rmac/fieldbus/canopen/nmt.hpp"

namespace rmac::fieldbus::canopen {
namespace {

/// Tells that a drive's supported modes (6502h, bit 0 is mode 1) lack one that it is to run in.
std::string cannot_do(const BootProblem& problem, const std::string& object) {
  std::string wanted, there;
  for (unsigned mode = 1; mode <= kMostMode; ++mode) {
    const std::uint32_t bit = 1U << (mode - 1);
    if ((problem.expected & ~problem.found & bit) != 0) {
      wanted += fmt::format("{}{} (mode {})", wanted.empty() ? "" : " and ", mode_name(mode), mode);
    }
    if ((problem.found & bit) != 0) there += fmt::format("{}{}", there.empty() ? "" : ", ", mode);
  }
  return fmt::format(" cannot do {}: {} says that it does the modes {}", wanted, object,
                     there.empty() ? "of its maker only" : there);
}

std::string name_of(std::uint8_t node, const CanopenConfig& config) {
  std::string axes;
  for (std::size_t i = 0; i < config.axes.size(); ++i) {
    if (config.axes[i].node == node) axes += fmt::format("{}{}", axes.empty() ? "" : ", ", i);
  }
  return fmt::format("node {} (axis {})", node, axes);
}

std::string refusal(const BootProblem& refused) {
  const std::string object = to_string(refused.object);
  const char* why = sdo_abort_text(refused.found);
  return refused.writing
             ? fmt::format("refused {:X}h for {}: {} ({:08X}h){}", refused.expected, object, why, refused.found,
                           refused.kept ? fmt::format(", and has {:X}h there", *refused.kept) : "")
             : fmt::format("refused to tell {}: {} ({:08X}h)", object, why, refused.found);
}

std::string state_name(std::uint32_t nmt_state) {
  switch (static_cast<NmtState>(nmt_state)) {
    case NmtState::Stopped:
      return "stopped";
    case NmtState::PreOperational:
      return "pre-operational";
    default:
      return fmt::format("in a state of its own ({})", nmt_state);
  }
}

std::string need(const BootProblem& problem) {
  return problem.needed[0] != '\0' ? fmt::format("; it is needed {}", problem.needed) : std::string();
}

/// What to do about a drive whose answers come late, if they come.
const char* patience(std::uint32_t abort_code) noexcept {
  return abort_code == sdo_abort::kTimeout ? "; a drive that takes longer to answer needs a longer sdo_timeout_ms" : "";
}

/// Of one of the PDOs that a drive has by default.
bool is_default_tpdo(ObjectAddress object) noexcept {
  return object.index > 0x1800 && object.index < 0x1804;
}

std::string describe_alone(const BootProblem& problem, std::uint8_t node, const CanopenConfig& config) {
  const std::string who = name_of(node, config);
  const double waited_s = std::chrono::duration<double>(problem.waited).count();
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
      return fmt::format("{} did not answer when {} was {}: {}{}", who, object, problem.writing ? "written" : "read",
                         sdo_abort_text(problem.found), patience(problem.found));
    case BootProblem::Kind::Refused:
      return fmt::format("{} {}{}", who, refusal(problem), need(problem));
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
      if (of_first_axis(problem.object).index == 0x6502) return who + cannot_do(problem, object);
      if (of_first_axis(problem.object).index == 0x607E) {
        return fmt::format(
            "{} turns its positions round ({} is {:X}h), and follows torques, so it could run away; set polarity to 0 "
            "and the actuator's Direction to -1, or polarity to {} where the drive turns its torques round, too",
            who, object, problem.found, problem.found & 0xFFU);
      }
      return fmt::format("{} does not support what is asked of it: {} is {:X}h, and {:X}h is needed in it{}", who,
                         object, problem.found, problem.expected, need(problem));
    case BootProblem::Kind::Constant:
      return fmt::format("{} keeps {:04X}h as it is, which will do: {} ({:08X}h)", who, problem.object.index,
                         sdo_abort_text(problem.found), problem.found);
    case BootProblem::Kind::Unfit:
      return fmt::format("{} cannot be taken: {}", who, problem.needed);
    case BootProblem::Kind::NoStart:
      return fmt::format("{} is set up, but did not become operational in {:g} s", who, waited_s);
    case BootProblem::Kind::Restarts:
      return who +
             " sends one boot-up message after the other while it is set up: it starts anew, or another device comes "
             "up "
             "with its node id, or its firmware repeats the message without getting further; check its supply, with "
             "rmac bus scan who is there, and its maker's notes";
    case BootProblem::Kind::Restarted:
      return who +
             " sent a boot-up message in operation: it started anew, or another device came up with its node id; "
             "check its supply, and with rmac bus scan who is there";
    case BootProblem::Kind::LeftOperational: {
      const auto emergency = static_cast<std::uint16_t>(problem.expected);
      return fmt::format(
          "{} left Operational, and says that it is {}{}: it heard this master no more, or somebody else told it to; "
          "rmac bus trace {} shows what comes",
          who, state_name(problem.found),
          emergency == 0 ? ""
                         : fmt::format("; its last emergency was {:04X}h ({})", emergency, emergency_text(emergency)),
          config.interface);
    }
    case BootProblem::Kind::Commanded:
      return fmt::format(
          "{}: another master sent NMT command {:02X}h for {}; a bus has one master, so take the other one, or the "
          "tool, "
          "off (rmac bus trace {} shows what it sends)",
          who, problem.found, problem.expected == 0 ? "all nodes" : fmt::format("node {}", problem.expected),
          config.interface);
    case BootProblem::Kind::TwoIdentities:
      return fmt::format(
          "{}: two devices have this node id: {} was told as {:X}h and as {:X}h; give each an id of its own (rmac bus "
          "scan shows them). Where the drive was exchanged, unload and load the machine",
          who, object, problem.expected, problem.found);
    case BootProblem::Kind::TwoAnswers:
      return who +
             ": two devices have this node id: one SYNC was answered more than once, and differently; give each "
             "an id of its own (rmac bus scan shows them)";
    case BootProblem::Kind::TwoHeartbeats:
      return who +
             ": two devices have this node id: there are twice the heartbeats of one; give each an id of its own "
             "(rmac bus scan shows them)";
  }
  return who;
}

}  // namespace

std::string describe_note(const BootProblem& refused, std::uint8_t node, const CanopenConfig& config) {
  if (refused.kind == BootProblem::Kind::Constant) return describe_alone(refused, node, config);
  return fmt::format("{} {}; it is not needed, and was passed over{}", name_of(node, config), refusal(refused),
                     is_default_tpdo(refused.object) ? ". What that PDO sends is not counted in the load" : "");
}

std::string describe(const BootProblem& problem, std::uint8_t node, const CanopenConfig& config) {
  using Kind = BootProblem::Kind;
  const bool by_file = problem.drive != nullptr && (problem.kind == Kind::NoAnswer || problem.kind == Kind::Refused ||
                                                    problem.kind == Kind::Different);
  const std::string what = describe_alone(problem, node, config);
  return by_file ? fmt::format("{}. It is treated as {} says", what, problem.drive->file) : what;
}

}  // namespace rmac::fieldbus::canopen
