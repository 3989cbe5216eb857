#pragma once

#include <cstddef>

#include "clients/legacy/gcode/mover.hpp"

namespace rmac::gcode {

/// G0 to G3, G28 and G30: where a block of them ends, and by which way.
class Motions {
 public:
  Motions(const Options& options, const Rules& rules, const Modes& modes, Coordinates& coordinates, Mover& mover,
          Compensation& compensation)
      : options_(options),
        rules_(rules),
        modes_(modes),
        coordinates_(coordinates),
        mover_(mover),
        compensation_(compensation) {}

  /// G0 or G1. `place`: of what asks for it.
  void straight(Block& block, bool rapid, std::size_t place);
  void arc(Block& block, bool counter_clockwise, std::size_t place);
  /// G28 and G30: by way of the place that the block names, if it names one, to the reference point.
  void reference(Block& block, const Code& code);
  [[nodiscard]] Point end_of(Block& block, std::size_t place);

 private:
  /// Where the program believes the tool to be.
  [[nodiscard]] Point start(std::size_t place);
  void go_along(const Arc& arc, double feed_mm_min, std::size_t place);
  void go_straight(const Point& end, bool rapid, std::size_t place);
  /// What rounding left between the end of an arc's circle and the end that is written.
  void go_to_written_end(const Point& end, double feed_mm_min, std::size_t place);
  /// A coordinate of a reference point, in the frame in force. Throws a Refusal where that leads there by no known way.
  [[nodiscard]] double reference_value(const Point& reference, std::size_t axis, std::size_t place) const;
  [[nodiscard]] double machine_value(const Word& word, std::size_t axis) const;
  [[nodiscard]] Point written_centre(Block& block, const Point& start, std::size_t place) const;

  const Options& options_;
  const Rules& rules_;
  const Modes& modes_;
  Coordinates& coordinates_;
  Mover& mover_;
  Compensation& compensation_;
};

}  // namespace rmac::gcode
