#pragma once

#include <vector>

#include "canopen/lss/lss_master.hpp"

namespace rmac::fieldbus::canopen {

/// Who has no node id, by fast scan (CiA 305): the master guesses the identity bit by bit, and whoever it can be says
/// so. Both values of a bit are tried and no node is taken out of the search: one that configures answers every step
/// in some stacks (CANopenNode), and would hide all others.
class FastScan {
 public:
  explicit FastScan(LssMaster& master) : master_(master), answer_time_(master.options().timeout) {}

  /// Up to `most` nodes; all wait afterwards. One identity as often as nodes answered to it.
  Expected<std::vector<Identity>> find(std::size_t most);
  /// The node without an id that has this identity configures from now on.
  Expected<> claim(const Identity& identity);

 private:
  /// What is known of an identity: the parts before `part`, and of it the bits from `bit` up.
  struct Prefix {
    IdentityParts parts{};
    std::uint8_t part = 0, bit = 32;
  };
  struct Search {
    std::vector<Identity> found;
    bool nobody = false;  ///< fits any identity, whoever answered the beginning
    bool lost = false;    ///< an answer led nowhere: it came late, and belonged to another step
  };

  Search search(std::size_t most);
  /// Follows a prefix to an identity; what else fits goes to `others`. The number of nodes that have it.
  std::size_t descend(Prefix& prefix, std::vector<Prefix>& others);
  bool narrow(Prefix& prefix, std::vector<Prefix>& others);
  /// Has all start anew, and those that fit go to the part of the prefix.
  bool replay(const Prefix& prefix);
  /// How many nodes fit the bits from `bit` up of a part; they go on to the part `next`.
  std::size_t step(std::uint32_t number, std::uint8_t bit, std::uint8_t part, std::uint8_t next);
  bool start();

  LssMaster& master_;
  std::chrono::nanoseconds answer_time_;
};

}  // namespace rmac::fieldbus::canopen
