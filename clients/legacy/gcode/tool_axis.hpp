#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/mover.hpp"

namespace rmac::gcode {

/// Which way the tool points, where a program says it: by A, B and C, which whoever imports it gives a meaning, or by
/// I, J and K under G43.5.
class ToolAxis {
 public:
  ToolAxis(const Options& options, const Modes& modes, Coordinates& coordinates, Mover& mover)
      : options_(options), modes_(modes), coordinates_(coordinates), mover_(mover) {}

  /// Takes the words of a block before it moves. Without X, Y and Z the tool turns where its tip is.
  void read(Block& block);

 private:
  void read_angles(Block& block, int motion);
  void read_vector(Block& block, int motion);
  /// False where no option gives the letter a meaning, and it says nothing but 0.
  [[nodiscard]] bool read_angle(char letter, const Word& word);
  [[nodiscard]] Point axis_of_angles(std::size_t place) const;
  void aim(const Block& block, const Point& axis, int motion, std::size_t place);

  const Options& options_;
  const Modes& modes_;
  Coordinates& coordinates_;
  Mover& mover_;
  std::array<std::optional<double>, 3> angles_{};  ///< of A, B and C, degrees
};

}  // namespace rmac::gcode
