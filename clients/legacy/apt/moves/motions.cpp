#include "clients/legacy/apt/moves/motions.hpp"

#include <utility>

#include "clients/legacy/apt/moves/feeds.hpp"

namespace rmac::apt {

void Motions::move(const Pose& end, std::size_t place) {
  if (arcs_.pending()) {
    if (drilling_.on()) refuse(place, "an arc where a CYCLE is in force; write CYCLE/OFF before it");
    return arcs_.end_at(end, take_feed(place), place);
  }
  arcs_.require_complete(place);
  const bool rapid = std::exchange(rapid_, false);
  if (drilling_.on()) {
    if (rapid) refuse(place, "RAPID to a hole of a CYCLE: a hole, or not? Write CYCLE/OFF before it, or no RAPID");
    return drilling_.drill(end, place);
  }
  if (rapid) return mover_.rapid(end, place);
  mover_.line(end, mover_.feed(place), place);
}

double Motions::take_feed(std::size_t place) {
  return std::exchange(rapid_, false) ? options_.rapid_mm_min : mover_.feed(place);
}

void Motions::go_to(Arguments& arguments) {
  const auto values = arguments.numbers({3, 6}, "x,y,z[,i,j,k]");
  arguments.end();
  move(coordinates_.pose(values, arguments.place()), arguments.place());
}

void Motions::go_by(Arguments& arguments) {
  const std::size_t place = arguments.place();
  const auto values = arguments.numbers({1, 3, 6}, "a way along the tool axis, or x,y,z[,i,j,k]");
  arguments.end();
  if (drilling_.on()) refuse(place, "GODLTA where a CYCLE is in force; write CYCLE/OFF before it");
  const Point axis_before = coordinates_.axis(place);
  const Point here = mover_.start(axis_before, place).tip;
  Pose end;
  if (values.size() == 1) {
    end = {along(here, coordinates_.mm(values.front(), place), axis_before), axis_before};
  } else {
    end = {along(here, 1, coordinates_.vector(triple(values, 0), place)), coordinates_.pose(values, place).axis};
  }
  move(end, place);
}

void Motions::from(Arguments& arguments) {
  const auto values = arguments.numbers({3, 6}, "x,y,z[,i,j,k]");
  arguments.end();
  static_cast<void>(coordinates_.pose(values, arguments.place()));
}

void Motions::go_home(Arguments& arguments) {
  arguments.end();
  arcs_.require_complete(arguments.place());
  if (drilling_.on()) refuse(arguments.place(), "GOHOME where a CYCLE is in force; write CYCLE/OFF before it");
  if (!options_.reference_mm) {
    refuse(arguments.place(),
           "where the machine's home is, in the coordinates of the part, is not known here; give --reference-point "
           "X,Y,Z, or take GOHOME out");
  }
  rapid_ = false;
  mover_.rapid({*options_.reference_mm, coordinates_.axis(arguments.place())}, arguments.place());
}

void Motions::set_rapid(Arguments& arguments) {
  arguments.end();
  rapid_ = true;
}

void Motions::set_feed(Arguments& arguments) {
  const double feed_mm_min = feed_of(arguments, coordinates_, feed_unit_);
  if (rapid_) refuse(arguments.place(), "FEDRAT between RAPID and the motion that is to be rapid: which one holds?");
  mover_.set_feed(feed_mm_min);
}

void Motions::follow(Arguments& arguments) {
  const std::size_t place = arguments.place();
  if (drilling_.on()) refuse(place, "an arc where a CYCLE is in force; write CYCLE/OFF before it");
  arcs_.follow(arguments, take_feed(place));
}

}  // namespace rmac::apt
