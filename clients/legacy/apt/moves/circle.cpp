#include "clients/legacy/apt/moves/circle.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "clients/legacy/apt/statements/refusal.hpp"
#include "clients/legacy/program/arc_geometry.hpp"

namespace rmac::apt {

namespace {

constexpr double kSamePlace_mm = 1.001e-3, kSameAngle_rad = 1e-6;
/// As of an arc's two radii.
constexpr double kMostOff_mm = 0.5, kOff_mm = 0.005, kRelative = 1e-3;

/// The coordinates in which a circle turns about an axis of its own. Where that is X, Y or Z they are the part's, so
/// that no digit is lost.
class CirclePlane {
 public:
  explicit CirclePlane(const Point& axis) {
    for (std::size_t i = 0; i < axis.size(); ++i) {
      if (std::abs(axis.at(i)) < 1 - 1e-12) continue;
      plane_ = {(i + 1) % 3, (i + 2) % 3, i};
      flipped_ = axis.at(i) < 0;
      return;
    }
    const std::size_t least = std::abs(axis[0]) < 0.6 ? 0 : 1;
    Point first = cross(legacy::unit_axis(least), axis);
    first = scaled(1 / length(first), first);
    own_ = Placement{first, cross(axis, first), axis, {}};
  }

  /// Whether the plane's axis points the other way than the circle's.
  [[nodiscard]] bool flipped() const noexcept { return flipped_; }
  [[nodiscard]] const legacy::Plane& plane() const noexcept { return plane_; }
  [[nodiscard]] Point axis() const { return own_ ? own_->z : legacy::unit_axis(plane_.normal); }
  [[nodiscard]] Point inside(const Point& part) const {
    return own_ ? Point{dot(part, own_->x), dot(part, own_->y), dot(part, own_->z)} : part;
  }
  [[nodiscard]] Point outside(const Point& own) const { return own_ ? own_->turned(own) : own; }

 private:
  legacy::Plane plane_;
  std::optional<Placement> own_;
  bool flipped_ = false;
};

Point spoke(const Circle& circle, const Point& point) {
  const Point from = difference(point, circle.centre);
  return along(from, -dot(from, circle.axis), circle.axis);
}

void require_radius(const Circle& circle, const Point& start, std::size_t place) {
  const double to_start = length(spoke(circle, start)), off = std::abs(to_start - circle.radius_mm);
  if (off <= kMostOff_mm && (off <= kOff_mm || off <= kRelative * circle.radius_mm)) return;
  refuse(place,
         fmt::format("the circle has the radius {:.6g} mm, and the arc begins {:.6g} mm from its centre; correct "
                     "one of them, or where the tool is before",
                     circle.radius_mm, to_start));
}

}  // namespace

double sweep_rad(const Circle& circle, const Point& start, const Point& end, bool counter_clockwise) {
  const Point from = spoke(circle, start), to = spoke(circle, end);
  const double ahead = std::atan2(dot(cross(from, to), circle.axis), dot(from, to));
  const double turn = counter_clockwise ? ahead : -ahead;
  return turn > kSameAngle_rad ? turn : turn + legacy::kTurn_rad;
}

bool is_same_place(const Circle& circle, const Point& a, const Point& b) {
  const Point way = difference(a, b);
  return length(along(way, -dot(way, circle.axis), circle.axis)) <= kSamePlace_mm;
}

void move_along(const Circle& circle, const ArcCourse& course, Mover& mover, std::size_t place) {
  const Point start = mover.start(course.end.axis, place).tip;
  require_radius(circle, start, place);
  const CirclePlane own(circle.axis);
  const Point end = own.inside(course.end.tip);
  legacy::Arc written{.centre = own.inside(circle.centre),
                      .end = end,
                      .axis = own.axis(),
                      .counter_clockwise = course.counter_clockwise != own.flipped(),
                      .closed = false,
                      .more_turns = course.more_turns};
  const auto kept = legacy::arc_about(own.inside(start), written, own.plane(), place);
  const bool reaches_end = kept && kept->end == end;
  if (kept) {
    legacy::Arc arc = *kept;
    arc.centre = own.outside(arc.centre);
    arc.end = reaches_end ? course.end.tip : own.outside(arc.end);
    mover.arc(arc, course.end.axis, course.feed_mm_min, place);
  }
  if (!reaches_end) mover.line(course.end, course.feed_mm_min, place);
}

}  // namespace rmac::apt
