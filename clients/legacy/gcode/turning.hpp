#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/doubts.hpp"
#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"

namespace rmac::gcode {

/// Coordinates that lie askew in those of the part: mirrored (G51.1), turned in the plane (G68), tilted (G68.2); in
/// this order, where several are.
class Turning {
 public:
  Turning(const Modes& modes, Coordinates& coordinates, Doubts& doubts, Mover& mover)
      : modes_(modes), coordinates_(coordinates), doubts_(doubts), mover_(mover) {}

  /// G51.1, G50.1, G68, G68.2 and G69 of a block.
  void act(Block& block);
  [[nodiscard]] bool tilted() const noexcept { return tilt_.has_value(); }
  /// G53.1 and G53.6: the tool along the normal of the tilted plane.
  void align(Block& block, std::size_t place);

 private:
  struct Turn {
    Plane plane;
    Point centre{};
    double degrees = 0;
  };

  void mirror(Block& block, const Code& code);
  void turn(Block& block, const Code& code);
  void tilt(Block& block, const Code& code);
  void end();
  void place();
  /// Whether a mirror turns the sense of a turn.
  [[nodiscard]] bool turns_back(const Turn& turn) const {
    return mirrors_.at(turn.plane.first).has_value() != mirrors_.at(turn.plane.second).has_value();
  }
  void require_centre_in_mirrors(const Turn& turn, std::size_t place) const;
  [[nodiscard]] double shift(std::size_t axis) const { return coordinates_.to_part(axis, 0); }

  const Modes& modes_;
  Coordinates& coordinates_;
  Doubts& doubts_;
  Mover& mover_;
  std::array<std::optional<double>, 3> mirrors_{};  ///< where along each axis
  std::optional<Turn> turn_;
  std::optional<legacy::Placement> tilt_;
};

}  // namespace rmac::gcode
