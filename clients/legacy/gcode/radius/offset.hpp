#pragma once

#include <optional>
#include <vector>

namespace rmac::gcode {

/// A place or a direction in XY, mm.
struct Flat {
  double x = 0, y = 0;
};

/// What the tool's centre goes along beside a line or an arc of a contour: a line, or an arc about the same centre.
/// Places on it are measured from its begin: in mm on a line, in radians on an arc.
class Offset {
 public:
  /// `left_mm`: how far left of the way it is; negative: right.
  static Offset of_line(const Flat& begin, const Flat& end, double left_mm);
  /// `sweep_rad` is positive. None where the arc is no larger than what it is to be within.
  static std::optional<Offset> of_arc(const Flat& begin, const Flat& centre, bool counter_clockwise, double sweep_rad,
                                      double left_mm);

  [[nodiscard]] double length() const noexcept { return length_; }
  [[nodiscard]] Flat at(double place) const;
  /// In which direction it begins and ends, of length 1.
  [[nodiscard]] Flat first_direction() const { return direction(0); }
  [[nodiscard]] Flat last_direction() const { return direction(length_); }
  /// Where a place that is about at its begin stands along it, which may be before that.
  [[nodiscard]] double near_begin(const Flat& place) const;
  /// Of one place, about a micrometre: what rounding takes for none.
  [[nodiscard]] double tolerance() const noexcept { return is_arc_ ? kSame_mm / radius_ : kSame_mm; }

  /// Whether a place is on a line's left, or on it (`left_mm` positive), or so on its right. Never beside an arc.
  [[nodiscard]] bool has_beside(const Flat& place, double left_mm) const;

  struct Meeting {
    double on_first = 0, on_second = 0;
  };
  /// Where the second crosses the first, not before `from` of that; the last such place. None where it does not.
  static std::optional<Meeting> meet(const Offset& first, double from, const Offset& second);

 private:
  static constexpr double kSame_mm = 1e-6;

  [[nodiscard]] Flat direction(double place) const;
  [[nodiscard]] double angle(double place) const noexcept { return angle_ + (left_turn_ ? place : -place); }
  /// Where a place that is on its line or circle stands on it: of several turns the last, or the first.
  [[nodiscard]] double measure(const Flat& place, bool last) const;
  static std::vector<Flat> crossings(const Offset& one, const Offset& other);
  static std::vector<Flat> crossings_of_lines(const Offset& one, const Offset& other);
  static std::vector<Flat> crossings_of_line(const Offset& line, const Offset& circle);
  static std::vector<Flat> crossings_of_circles(const Offset& one, const Offset& other);

  bool is_arc_ = false, left_turn_ = false;
  Flat begin_{}, along_{};  ///< of a line: where it begins, and its direction
  Flat centre_{};           ///< of an arc, as what follows
  double radius_ = 0, angle_ = 0;
  double length_ = 0;
};

}  // namespace rmac::gcode
