#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "clients/legacy/apt/moves/options.hpp"
#include "clients/legacy/apt/moves/vectors.hpp"
#include "clients/legacy/apt/statements/arguments.hpp"

namespace rmac::apt {

/// What a program's numbers mean: their unit, what copies and TRANS do to them, and the tool axis in force.
class Coordinates {
 public:
  explicit Coordinates(const Options& options) : unit_mm_(options.unit_mm), multax_(options.multax) {}

  /// UNITS/MM, INCHES, INCH.
  void set_unit(Arguments& arguments);
  /// MULTAX, MULTAX/ON and OFF.
  void set_multax(Arguments& arguments);
  /// TLAXIS/i,j,k.
  void set_axis(Arguments& arguments);
  /// TRANS/x,y,z: added to all coordinates that follow, in the place of an earlier one.
  void set_translation(Arguments& arguments);

  /// Throws a Refusal where no unit is known.
  [[nodiscard]] double unit_mm(std::size_t place) const;
  [[nodiscard]] double mm(double value, std::size_t place) const { return value * unit_mm(place); }
  /// Of the part, in mm.
  [[nodiscard]] Point point(const Point& program, std::size_t place) const;
  [[nodiscard]] Point vector(const Point& program, std::size_t place) const;
  /// Of unit length. Throws a Refusal where the numbers have no direction.
  [[nodiscard]] Point direction(const Point& program, std::size_t place) const;
  /// Where three or six of GOTO's numbers lead; six set the tool axis.
  [[nodiscard]] Pose pose(const std::vector<double>& values, std::size_t place);
  /// The tool axis in force. Throws a Refusal where it may not be what it is.
  [[nodiscard]] Point axis(std::size_t place) const;

  [[nodiscard]] const Placement& placement() const noexcept { return placement_; }
  void set_placement(const Placement& placement) noexcept { placement_ = placement; }

 private:
  void take_axis(const Point& program, std::size_t place);

  std::optional<double> unit_mm_;
  bool multax_;
  Point axis_ = legacy::unit_axis(2), translation_{};
  Placement placement_;
};

/// Three of the numbers, from the one at `first`.
[[nodiscard]] inline Point triple(const std::vector<double>& values, std::size_t first) {
  return {values.at(first), values.at(first + 1), values.at(first + 2)};
}

}  // namespace rmac::apt
