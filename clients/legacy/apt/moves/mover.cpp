#include "clients/legacy/apt/moves/mover.hpp"

#include <cmath>

#include "clients/legacy/apt/statements/refusal.hpp"

namespace rmac::apt {

double Mover::feed(std::size_t place) const {
  if (feed_mm_min_ == 0) refuse(place, "no feed was set before this move; write FEDRAT, or RAPID");
  return feed_mm_min_;
}

void Mover::write_feed(double mm_min, std::size_t place) {
  if (!legacy::is_feed(mm_min)) refuse(place, "the feed is not within 0.01 and 1 000 000 mm/min");
  if (written_mm_min_ != mm_min) writer_.feed(mm_min);
  written_mm_min_ = mm_min;
}

void Mover::require_reach(const Point& point, std::size_t place) {
  for (const double value : point) {
    if (!(std::abs(value) <= legacy::kFarthest_mm)) refuse(place, "a move beyond 1 000 000 mm");
  }
}

void Mover::move_to(const Pose& end) {
  if (!here_ || here_->axis != end.axis) writer_.tool_axis(end.axis);
  here_ = end;
}

const Pose& Mover::start(const Point& axis, std::size_t place) {
  if (!here_) {
    if (!options_.approach_mm) {
      refuse(place,
             "where the tool is before this move is not known (FROM tells it of the CAM system's machine only); begin, "
             "and go on after a tool change, with RAPID and a GOTO, or give --approach X,Y,Z");
    }
    rapid({*options_.approach_mm, axis}, place);
  }
  return *here_;
}

void Mover::rapid(const Pose& end, std::size_t place) {
  require_reach(end.tip, place);
  if (here_ == end) return;
  write_feed(options_.rapid_mm_min, place);
  move_to(end);
  writer_.rapid(end.tip);
}

void Mover::line(const Pose& end, double feed_mm_min, std::size_t place) {
  require_reach(end.tip, place);
  static_cast<void>(start(end.axis, place));
  write_feed(feed_mm_min, place);
  move_to(end);
  writer_.line(end.tip);
}

void Mover::arc(const legacy::Arc& arc, const Point& axis, double feed_mm_min, std::size_t place) {
  require_reach(arc.end, place);
  require_reach(arc.centre, place);
  static_cast<void>(start(axis, place));
  write_feed(feed_mm_min, place);
  move_to({arc.end, axis});
  writer_.arc(arc);
}

}  // namespace rmac::apt
