#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"
#include "clients/legacy/gcode/turning.hpp"
#include "clients/legacy/gcode/turntable.hpp"

namespace rmac::gcode {

/// Which way the tool points, where a program says it: by A, B and C, which whoever imports it gives a meaning, or by
/// I, J and K under G43.5.
class ToolAxis {
 public:
  ToolAxis(const Options& options, const Rules& rules, const Modes& modes, Coordinates& coordinates,
           const Turning& turning, Mover& mover)
      : options_(options),
        rules_(rules),
        modes_(modes),
        coordinates_(coordinates),
        turning_(turning),
        mover_(mover),
        turntable_(options, rules, modes, coordinates, turning, mover) {}

  /// Takes the words of a block before it moves. Without X, Y and Z the tool turns where its tip is.
  void read(Block& block);
  /// Other modes, or another frame of the part, may be in force than before.
  void settle(std::size_t place) {
    if (!at_reference_) turntable_.settle(angles_, place);
  }
  void follow(std::size_t place) {
    if (!at_reference_) turntable_.follow(angles_, place);
  }
  /// Throws a Refusal where what X, Y and Z of a motion are, of the part, or under G53 of the machine, is not known.
  void require_coordinates(const Block& block, std::size_t place) const {
    return block.once(kInMachine) ? require_axes_of_machine(block, place) : require_coordinates_of_part(place);
  }
  /// Throws a Refusal where G28, G30 or G53 go along axes of the machine, and how those lie to the part is not known.
  void require_axes_of_machine(const Block& block, std::size_t place) const;

 private:
  static constexpr int kInMachine = 530;

  /// Throws a Refusal where A, B and C turned the part below the tool, or away from it.
  void require_coordinates_of_part(std::size_t place) const;
  /// Throws a Refusal as long as an axis stands where G28 took it.
  void require_none_at_reference(std::size_t place) const;
  void read_angles(Block& block, int motion);
  void leave_for_reference(const Block& block);
  void read_vector(Block& block, int motion);
  /// None where --rotary does not have it.
  [[nodiscard]] const RotaryAxis* rotary(char letter) const {
    const auto found = std::ranges::find(options_.rotary, letter, &RotaryAxis::letter);
    return found != options_.rotary.end() ? &*found : nullptr;
  }
  void turn(Block& block, const KnownAngles& before, int motion, std::size_t place);
  [[noreturn]] static void refuse_coordinates(std::size_t place);
  /// False where no option gives the letter a meaning, and it says nothing but 0.
  [[nodiscard]] bool read_angle(char letter, const Word& word);
  [[nodiscard]] legacy::Placement turn_of_angles(std::size_t place) const;
  void aim(const Block& block, const Point& axis, int motion, std::size_t place);

  const Options& options_;
  const Rules& rules_;
  const Modes& modes_;
  Coordinates& coordinates_;
  const Turning& turning_;
  Mover& mover_;
  Turntable turntable_;
  KnownAngles angles_{};
  legacy::Placement turn_{};          ///< that they make of coordinates
  std::optional<char> at_reference_;  ///< the axis that G28 took to where nobody knows
};

}  // namespace rmac::gcode
