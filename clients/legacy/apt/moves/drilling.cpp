#include "clients/legacy/apt/moves/drilling.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/program/pecking.hpp"

namespace rmac::apt {

namespace {

/// Heights that differ by less are one.
constexpr double kLevel_mm = 1e-6;

double height(const Pose& pose) {
  return dot(pose.tip, pose.axis);
}
Pose moved(const Pose& pose, double amount) {
  return {along(pose.tip, amount, pose.axis), pose.axis};
}

}  // namespace

void Drilling::set(Arguments& arguments) {
  if (arguments.take("OFF")) {
    on_ = false;
  } else if (arguments.take("ON")) {
    if (!cycle_) refuse(arguments.place(), "CYCLE/ON without a cycle before it");
    on_ = true;
  } else {
    cycle_ = cycle_of(arguments, coordinates_);
    on_ = true;
  }
  arguments.end();
  began_mm_.reset();
}

/// Up first where the tool is lower than it is to be, then across, then down.
void Drilling::go_above(const Pose& above, std::size_t place) {
  const Pose here = mover_.start(above.axis, place);
  if (here.axis != above.axis) {
    refuse(place, "the tool axis turns on the way to a hole; write CYCLE/OFF, the way there, and CYCLE again");
  }
  if (!began_mm_) began_mm_ = height(here);
  const double lower = height(above) - height(here);
  if (lower > kLevel_mm) mover_.rapid(moved(here, lower), place);
  if (lower < -kLevel_mm) mover_.rapid(moved(above, -lower), place);
  mover_.rapid(above, place);
}

void Drilling::peck(const Pose& above, double feed_mm_min, std::size_t place) {
  const double whole_mm = cycle_->clear_mm + cycle_->depth_mm;
  if (!(whole_mm / cycle_->peck_mm <= legacy::kMostPecks))
    refuse(place, fmt::format("more than {} pecks in one hole", legacy::kMostPecks));
  const int count = legacy::pecks_to(whole_mm, cycle_->peck_mm);
  for (int number = 1; number < count; ++number) {
    const double reached_mm = number * cycle_->peck_mm;
    mover_.line(moved(above, -reached_mm), feed_mm_min, place);
    if (cycle_->pecks == Cycle::Pecks::Clearing) mover_.rapid(above, place);
    mover_.rapid(moved(above, -std::max(0.0, reached_mm - legacy::kPeckBackOff_mm)), place);
  }
}

void Drilling::drill(const Pose& top, std::size_t place) {
  const double feed_mm_min = cycle_->feed_mm_min ? *cycle_->feed_mm_min : mover_.feed(place);
  const Pose above = moved(top, cycle_->clear_mm);
  go_above(above, place);
  if (cycle_->pecks != Cycle::Pecks::None) peck(above, feed_mm_min, place);
  mover_.line(moved(top, -cycle_->depth_mm), feed_mm_min, place);
  if (cycle_->dwell_s) writer_.dwell(*cycle_->dwell_s);
  if (cycle_->comes_up_at_feed) mover_.line(above, feed_mm_min, place);
  double back_mm = cycle_->return_mm.value_or(cycle_->clear_mm);
  if (cycle_->returns_to_where_it_began) back_mm = std::max(cycle_->clear_mm, *began_mm_ - height(top));
  mover_.rapid(moved(top, back_mm), place);
}

}  // namespace rmac::apt
