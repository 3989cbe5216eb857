#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"
#include "clients/legacy/gcode/turning.hpp"

namespace rmac::gcode {

/// Which way the tool points, where a program says it: by A, B and C, which whoever imports it gives a meaning, or by
/// I, J and K under G43.5.
class ToolAxis {
 public:
  ToolAxis(const Options& options, const Modes& modes, Coordinates& coordinates, const Turning& turning, Mover& mover)
      : options_(options), modes_(modes), coordinates_(coordinates), turning_(turning), mover_(mover) {}

  /// Takes the words of a block before it moves. Without X, Y and Z the tool turns where its tip is.
  void read(Block& block);
  /// Throws a Refusal where X, Y and Z are not those of the part: A, B and C turned that below the tool, or away from
  /// it.
  void require_coordinates_of_part(std::size_t place) const;

 private:
  void read_angles(Block& block, int motion);
  void leave_for_reference(const Block& block);
  void read_vector(Block& block, int motion);
  [[nodiscard]] bool is_rotary(char letter) const {
    return std::ranges::find(options_.rotary, letter, &RotaryAxis::letter) != options_.rotary.end();
  }
  /// False where no option gives the letter a meaning, and it says nothing but 0.
  [[nodiscard]] bool read_angle(char letter, const Word& word);
  [[nodiscard]] legacy::Placement turn_of_angles(std::size_t place) const;
  void aim(const Block& block, const Point& axis, int motion, std::size_t place);

  const Options& options_;
  const Modes& modes_;
  Coordinates& coordinates_;
  const Turning& turning_;
  Mover& mover_;
  std::array<std::optional<double>, 3> angles_{};  ///< of A, B and C, degrees
  legacy::Placement turn_{};                       ///< that they make of coordinates
  std::optional<char> at_reference_;               ///< the axis that G28 took to where nobody knows
};

}  // namespace rmac::gcode
