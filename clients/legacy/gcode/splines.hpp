#pragma once

#include <cstddef>

#include "clients/legacy/gcode/motions.hpp"

namespace rmac::gcode {

/// G5 (cubic), G5.1 (quadratic) and the blocks from G5.2 to G5.3 (a NURBS): curves in the XY plane, as they are.
class Splines {
 public:
  Splines(Motions& motions, const Modes& modes, Mover& mover) : motions_(motions), modes_(modes), mover_(mover) {}

  /// `code` and that of the motion before: tenfold.
  void move(Block& block, int code, int before, std::size_t place);
  /// Between G5.2 and G5.3, where each block is a control point.
  [[nodiscard]] bool open() const noexcept { return !curve_.points.empty(); }
  void go_on(Block& block);
  void require_closed(std::size_t place) const;

 private:
  [[nodiscard]] Point begin(Block& block, std::size_t place);
  [[nodiscard]] Point relative(const Point& to, const Word& first, const Word& second) const;
  void cubic(Block& block, int before, std::size_t place);
  void quadratic(Block& block, std::size_t place);
  void open_curve(Block& block, std::size_t place);
  void add_point(Block& block, std::size_t place);
  void set_order(const Word& word);
  [[nodiscard]] static double weight_of(const Word& word);
  void close_curve(std::size_t place);

  Motions& motions_;
  const Modes& modes_;
  Mover& mover_;
  Point mirrored_{};     ///< of the last cubic: from its end to the control point before it, the other way
  legacy::Nurbs curve_;  ///< that is open
};

}  // namespace rmac::gcode
