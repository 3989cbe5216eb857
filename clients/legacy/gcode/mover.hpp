#pragma once

#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/radius/compensation.hpp"

namespace rmac::gcode {

/// Moves the tip, in coordinates of the part, and sees that all is written which a move of `.rmac` needs before it: its
/// frame, its feed, and where it begins. Places are for refusals.
class Mover {
 public:
  Mover(const Options& options, const Modes& modes, Coordinates& coordinates, Writer& writer)
      : options_(options), modes_(modes), coordinates_(coordinates), writer_(writer) {}

  void rapid(const Point& end, std::size_t place);
  void line(const Point& end, std::size_t place) { line(end, modes_.feed_mm_min, place); }
  void line(const Point& end, double feed_mm_min, std::size_t place);
  void arc(const Arc& arc, std::size_t place) { this->arc(arc, modes_.feed_mm_min, place); }
  void arc(const Arc& arc, double feed_mm_min, std::size_t place);
  /// One that was held back until the move behind it was known.
  void held(const ContourMove& move, std::size_t place);
  /// Turns the tool's axis, of the part, where the tip is; or with the next rapid, where nobody knows that.
  void turn(const Point& axis, std::size_t place);
  /// That the moves which follow end with.
  void aim(const Point& axis);
  [[nodiscard]] const Point& axis() const noexcept { return axis_; }
  void nurbs(const legacy::Nurbs& curve, std::size_t place);
  /// A rapid to where whoever imports the program says that the tip is, whether or not the tool's length counts.
  void reference(const Point& end, std::size_t place);
  /// Of the source, that is carried out.
  [[nodiscard]] std::size_t line() const noexcept { return writer_.line(); }
  /// Makes the tip's place known, by the approach where nothing else tells it.
  [[nodiscard]] Point start(std::size_t place);

 private:
  void require_reach(const Point& point, std::size_t place) const;
  [[nodiscard]] Arc placed(const Arc& arc) const;
  void go(const Point& end, std::size_t place);
  void prepare(const Point& end, std::size_t place);
  void prepare_feed(const Point& end, double feed_mm_min, std::size_t place);
  void write_feed(double mm_min, std::size_t place);
  void write_rapid(const Point& end, std::size_t place);
  void write_frame();

  const Options& options_;
  const Modes& modes_;
  Coordinates& coordinates_;
  Writer& writer_;
  std::optional<Point> frame_;                                            ///< that was written
  double feed_mm_min_ = 0;                                                ///< likewise
  Point axis_ = legacy::unit_axis(2), axis_here_ = legacy::unit_axis(2);  ///< of the next end, and of the last one
};

}  // namespace rmac::gcode
