#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"
#include "clients/legacy/gcode/turning.hpp"

namespace rmac::gcode {

/// Of A, B and C, degrees, where they are known.
using KnownAngles = std::array<std::optional<double>, 3>;

/// Of A, B or C, among angles.
[[nodiscard]] constexpr std::size_t index_of(char letter) {
  return static_cast<std::size_t>(letter - 'A');
}
/// Whether an axis stands as it does at 0, where it is taken to be as long as nobody says otherwise.
[[nodiscard]] bool is_upright(const RotaryAxis& axis, const KnownAngles& angles);
[[nodiscard]] TableAngles zeros_for_unknown(const KnownAngles& angles);

/// A table that A, B and C turn, under X, Y and Z of a machine whose tool stands upright: those axes of --rotary of
/// which it is known where they are. Not in force under G43.4, G43.5 and G68.2, which say where on the part X, Y and Z
/// are.
class Turntable {
 public:
  Turntable(const Options& options, const Rules& rules, const Modes& modes, Coordinates& coordinates,
            const Turning& turning, Mover& mover)
      : options_(options), rules_(rules), modes_(modes), coordinates_(coordinates), turning_(turning), mover_(mover) {}

  [[nodiscard]] bool in_force() const { return modes_.centre_point == ToolCentrePoint::Off && !turning_.tilted(); }
  /// Whether the table alone turns to these angles, or has.
  [[nodiscard]] bool carries(const KnownAngles& angles) const;
  /// The angle that `degrees` under G90 mean of an axis.
  [[nodiscard]] double led(const RotaryAxis& axis, double from, const Word& word, double degrees) const;
  /// With the motion of a block, whose code is `motion`; by the next one, where nobody knows where the tip is. `begin`:
  /// none where it is not known where the table stands.
  void turn(const std::optional<TableAngles>& begin, const TableAngles& end, int motion, std::size_t place);
  /// Other modes are in force: what X, Y and Z mean now of a table that stands so.
  void settle(const KnownAngles& angles, std::size_t place);
  /// The frame of the part is another one: the tip stays in the machine.
  void follow(const KnownAngles& angles, std::size_t place);

 private:
  /// In the frame in force. Throws a Refusal where that is not known.
  [[nodiscard]] Table table(std::size_t place) const;
  [[nodiscard]] std::optional<legacy::Placement> placement(const KnownAngles& angles, std::size_t place) const;

  const Options& options_;
  const Rules& rules_;
  const Modes& modes_;
  Coordinates& coordinates_;
  const Turning& turning_;
  Mover& mover_;
};

}  // namespace rmac::gcode
