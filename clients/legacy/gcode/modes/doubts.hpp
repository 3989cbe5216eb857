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
  void about(std::size_t axis) { doubtful_.at(axis) = true; }
  /// Where the tool is in X and Y, nobody knows. `why` begins the refusal, and outlives this.
  void leave_open(std::string_view why);
  /// The tool goes elsewhere: what leaves it open is over.
  void settle();
  /// Whether that is so of an axis.
  [[nodiscard]] bool left_open(std::size_t axis) const { return !why_.empty() && axis != 2 && doubtful_.at(axis); }
  /// Throws a Refusal where it is so of one.
  void require_none(std::size_t place) const;
  /// Likewise, where a block sets what the coordinates of the tool are.
  void require_none_of(const Block& block) const;

  /// Throws a Refusal where a motion goes on from a doubtful place: it names all such axes, under G90, or is a straight
  /// way up. `code`: tenfold.
  void require_whole(Block& block, int code, const Rules::Cycles& cycles, std::size_t place);

 private:
  /// Whether a straight motion without X and Y, or a cycle that only sets its words, does nothing there.
  [[nodiscard]] bool stays_clear(Block& block, int code, const Rules::Cycles& cycles) const;

  const Modes& modes_;
  const Coordinates& coordinates_;
  std::array<bool, 3> doubtful_{};
  std::string_view why_;
};

}  // namespace rmac::gcode
