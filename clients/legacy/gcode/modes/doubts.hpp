#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "clients/legacy/gcode/modes/modes.hpp"

namespace rmac::gcode {

/// Where the tool is by the words of a program, and controls differ in what they make of them: a block that goes on
/// from there is refused until the axes are named.
class Doubts {
 public:
  Doubts(const Modes& modes, const Coordinates& coordinates) : modes_(modes), coordinates_(coordinates) {}

  /// The coordinate of an axis is another than the program's last one, behind a turn or a mirror.
  void about(std::size_t axis) { turned_.at(axis) = true; }
  /// Where the tool is in X and Y, nobody knows. `why` begins the refusal, and outlives this.
  void leave_open(std::string_view why);
  /// The tool goes elsewhere: what leaves it open is over, of all axes or of one.
  void settle();
  void settle(std::size_t axis);
  /// Whether that is so of an axis.
  [[nodiscard]] bool left_open(std::size_t axis) const { return open_.at(axis); }
  /// Throws a Refusal where it is so of one.
  void require_none(std::size_t place) const;
  /// Likewise where X or Y is doubtful for any reason: a motion is about to go by where the tool is.
  void require_known(std::size_t place) const;
  /// Likewise, where a block sets what the coordinates of the tool are.
  void require_none_of(const Block& block) const;

  /// Throws a Refusal where a motion goes on from a doubtful place: it names all such axes, under G90, or is a straight
  /// way up, or one in the machine (G53), which settles the axes that it names. `code`: tenfold.
  void require_whole(Block& block, int code, const Rules::Cycles& cycles, std::size_t place);
  /// Throws a Refusal where a way to the reference point (G28, G30) begins downwards at a place that is left open; it
  /// settles the axes that it takes there.
  void reach_reference(Block& block);

 private:
  /// Whether a straight motion without X and Y, or a cycle that only sets its words, does nothing there.
  [[nodiscard]] bool stays_clear(Block& block, int code, const Rules::Cycles& cycles) const;
  [[nodiscard]] bool leads_up(Block& block) const;

  const Modes& modes_;
  const Coordinates& coordinates_;
  std::array<bool, 3> turned_{};  ///< by a turn or a mirror
  std::array<bool, 3> open_{};    ///< never Z
  std::string_view why_;
};

}  // namespace rmac::gcode
