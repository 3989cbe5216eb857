#pragma once

#include <cstddef>
#include <optional>

#include "clients/legacy/apt/moves/circle.hpp"
#include "clients/legacy/apt/moves/coordinates.hpp"

namespace rmac::apt {

/// Arcs in the two ways of CL files: a curve that the tool is driven along, as CATIA writes it, and a record of the
/// circle before the GOTO to the arc's end, as NX and others do.
class Arcs {
 public:
  Arcs(const Options& options, const Coordinates& coordinates, Mover& mover)
      : options_(options), coordinates_(coordinates), mover_(mover) {}

  /// INDIRV/i,j,k: which way the next arc begins.
  void set_forward(Arguments& arguments);
  /// PSIS/(PLANE/…): the plane that the next arc stays on.
  void set_surface(Arguments& arguments);
  /// TLON,GOFWD/(CIRCLE/…),ON[,n,INTOF],(LINE/…), or about a CYLNDR to a PLANE.
  void follow(Arguments& arguments, double feed_mm_min);

  /// CIRCLE/x,y,z[,i,j,k],r[,…][,TIMES,n], before a GOTO.
  void set_circle(Arguments& arguments);
  /// MOVARC/x,y,z,i,j,k,r,ANGLE,a, likewise.
  void set_arc(Arguments& arguments);
  /// Whether the next move is the end of an arc.
  [[nodiscard]] bool pending() const noexcept { return record_.has_value(); }
  void end_at(const Pose& end, double feed_mm_min, std::size_t place);

  /// Refuses what was said of an arc that does not come.
  void require_complete(std::size_t place) const;

 private:
  /// A circle before the GOTO to the arc's end, and what tells how far about it the arc goes.
  struct Record {
    Circle circle;
    std::size_t place = 0;
    std::optional<bool> counter_clockwise;
    std::optional<int> turns;         ///< TIMES
    std::optional<double> angle_rad;  ///< of all of it, never negative
  };

  [[nodiscard]] Circle circle_of(const std::vector<double>& values, std::size_t place) const;
  [[nodiscard]] Circle followed_circle(const Element& element);
  [[nodiscard]] Point followed_end(const Element& element, const Circle& circle) const;
  [[nodiscard]] bool direction_of(const Circle& circle, const Point& start, std::size_t place) const;
  [[nodiscard]] static int turns_of(const Record& record, double sweep_rad, bool whole);
  void require_meeting(int meeting, double sweep_rad, bool whole, const Circle& circle, std::size_t place) const;

  const Options& options_;
  const Coordinates& coordinates_;
  Mover& mover_;
  std::optional<Point> forward_, surface_;  ///< directions in the part
  std::optional<Record> record_;
};

}  // namespace rmac::apt
