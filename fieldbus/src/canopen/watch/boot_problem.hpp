#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "rmac/fieldbus/canopen/canopen_config.hpp"

namespace rmac::fieldbus::canopen {

/// Why a node did not come up, or is away again.
struct BootProblem {
  enum class Kind : std::uint8_t {
    None,
    NoBootUp,         ///< it never spoke
    NoAnswer,         ///< it spoke, but did not answer for `object`
    Refused,          ///< it refused `object`; `found` is its abort code
    Different,        ///< `object` is `found` where `expected` was
    Constant,         ///< it refused to take `object`, which is what is wanted; `found` is its abort code
    Unfit,            ///< its description does not fit: `needed` says why
    NoStart,          ///< it is set up, and does not become operational
    Restarts,         ///< it started anew, again and again, while it was set up
    Restarted,        ///< it started anew while it was operational
    LeftOperational,  ///< it said that it is in the NMT state `found`; `expected` is its last emergency
    Commanded,        ///< another master sent the NMT command `found` to the node `expected`; 0: to all
    // What shows two devices of one node id:
    TwoIdentities,  ///< `object` was told as `expected`, and as `found`
    TwoAnswers,     ///< one SYNC is answered twice, and differently
    TwoHeartbeats,  ///< more heartbeats than one node makes
  };
  Kind kind = Kind::None;
  ObjectAddress object;
  std::uint32_t expected = 0;
  std::uint32_t found = 0;
  std::optional<std::uint32_t> kept{};  ///< what `object` is, of one that could have been a constant
  bool writing = false;
  const char* needed = "";                  ///< for what, of an object that was refused
  std::chrono::milliseconds waited{0};      ///< for what did not come
  const DriveDescription* drive = nullptr;  ///< its description; null: none
};

/// It was operational, and said itself what became of it, or was told to by another: it is not silent.
[[nodiscard]] constexpr bool spoke(BootProblem::Kind kind) noexcept {
  return kind >= BootProblem::Kind::Restarted;
}
/// Two devices have the node's id.
[[nodiscard]] constexpr bool shows_two(BootProblem::Kind kind) noexcept {
  return kind >= BootProblem::Kind::TwoIdentities;
}

/// What a node refused, and was taken all the same, for a person.
[[nodiscard]] std::string describe_note(const BootProblem& refused, std::uint8_t node, const CanopenConfig& config);

/// What went wrong and what to do, for a person.
[[nodiscard]] std::string describe(const BootProblem& problem, std::uint8_t node, const CanopenConfig& config);

}  // namespace rmac::fieldbus::canopen
