#pragma once

#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/modes/modes.hpp"
#include "clients/legacy/gcode/radius/compensation.hpp"
#include "clients/legacy/gcode/table/turned_move.hpp"

namespace rmac::gcode {

/// Moves the tip, in coordinates of the part, and sees that all is written which a move of `.rmac` needs before it: its
/// frame, its feed, and where it begins. Places are for refusals.
class Mover {
 public:
  Mover(const Options& options, const Rules& rules, const Modes& modes, Coordinates& coordinates, Writer& writer)
      : options_(options), rules_(rules), modes_(modes), coordinates_(coordinates), writer_(writer) {}

  void rapid(const Point& end, std::size_t place);
  void line(const Point& end, std::size_t place);
  void line(const Point& end, double feed_mm_min, std::size_t place);
  void arc(const Arc& arc, double feed_mm_min, std::size_t place);
  /// One that was held back until the move behind it was known.
  void held(const ContourMove& move, std::size_t place);
  /// Turns the tool's axis, of the part, where the tip is; or with the next rapid, where nobody knows that.
  void turn(const Point& axis, std::size_t place);
  /// That the moves which follow end with.
  void aim(const Point& axis);
  [[nodiscard]] const Point& axis() const noexcept { return axis_; }
  /// The next straight move, or rapid, turns the table along with it, from where it stands. The tip is known.
  void turn_with_next(Table table, const TableAngles& begin, const TableAngles& end);
  /// The tool has this axis on the part, and on which way it comes there nobody knows: the next rapid is one of all
  /// joints together.
  void turn_unseen(const Point& axis);
  /// Whether the table is still to turn, though no X, Y and Z may ask for a move.
  [[nodiscard]] bool turns() const { return turn_ || (by_joints_ && coordinates_.tip_is_known()); }
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
  void turn_along(const Point& end, bool rapid, std::size_t place);

  struct Turn {
    Table table;
    TableAngles begin{}, end{};
  };

  const Options& options_;
  const Rules& rules_;
  const Modes& modes_;
  Coordinates& coordinates_;
  Writer& writer_;
  std::optional<Point> frame_;  ///< that was written
  double feed_mm_min_ = 0;      ///< likewise
  std::optional<Turn> turn_;
  bool by_joints_ = false;
  Point axis_ = legacy::unit_axis(2), axis_here_ = legacy::unit_axis(2);  ///< of the next end, and of the last one
};

}  // namespace rmac::gcode
