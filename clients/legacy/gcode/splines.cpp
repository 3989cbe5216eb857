#include "clients/legacy/gcode/splines.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace rmac::gcode {

namespace {

constexpr int kCubic = 50, kQuadratic = 51, kNurbs = 52;
/// rs274's order where none is said; L raises it. The appliance takes degrees to 9.
constexpr int kOrder = 3, kMostOrder = 10;
constexpr double kMostWeight = 1e6;
constexpr std::size_t kMostPoints = 10'000;

}  // namespace

void Splines::require_closed(std::size_t place) const {
  if (open()) refuse(place, "a NURBS that G5.2 began is not ended; write G5.3 behind its last control point");
}

Point Splines::begin(Block& block, std::size_t place) {
  if (modes_.plane.normal != 2) refuse(place, "splines lie in the XY plane; write G17 before them");
  if (block.once(530)) refuse(place, "G53 goes with G0 and G1 only");
  if (block.has('Z')) refuse(block.use('Z').place, "a spline has no Z: it lies in the XY plane");
  return mover_.start(place);
}

Point Splines::relative(const Point& to, const Word& first, const Word& second) const {
  return {to[0] + modes_.mm(first), to[1] + modes_.mm(second), to[2]};
}

void Splines::move(Block& block, int code, int before, std::size_t place) {
  if (code == kCubic) return cubic(block, before, place);
  if (code == kQuadratic) return quadratic(block, place);
  if (code == kNurbs) return open_curve(block, place);
  refuse(place, "G5.3 without a G5.2 before it");
}

void Splines::cubic(Block& block, int before, std::size_t place) {
  const Point start = begin(block, place);
  if (!block.has('P') || !block.has('Q')) refuse(place, "G5 needs P and Q, from its end to the second control point");
  if (block.has('I') != block.has('J')) refuse(place, "G5 has both I and J, or neither");
  if (!block.has('I') && before != kCubic)
    refuse(place, "the first G5 needs I and J, from its start to the first control point");
  const Point end = motions_.end_of(block, place);
  const Point first = block.has('I') ? relative(start, block.use('I'), block.use('J'))
                                     : Point{start[0] + mirrored_[0], start[1] + mirrored_[1], start[2]};
  const Point second = relative(end, block.use('P'), block.use('Q'));
  mirrored_ = {end[0] - second[0], end[1] - second[1], 0};
  mover_.nurbs({3, {start, first, second, end}, {}}, place);
}

void Splines::quadratic(Block& block, std::size_t place) {
  const Point start = begin(block, place);
  if (!block.has('I') || !block.has('J')) refuse(place, "G5.1 needs I and J, from its start to its control point");
  const Point control = relative(start, block.use('I'), block.use('J'));
  mover_.nurbs({2, {start, control, motions_.end_of(block, place)}, {}}, place);
}

void Splines::open_curve(Block& block, std::size_t place) {
  const Point start = begin(block, place);
  const bool weighs_start = !block.has_any("XY");
  double weight = 1;
  if (const Word* word = weighs_start ? block.find('P') : nullptr) weight = weight_of(*word);
  curve_ = {kOrder - 1, {start}, {weight}};
  if (!weighs_start) return add_point(block, place);
  if (const Word* order = block.find('L')) set_order(*order);
}

void Splines::set_order(const Word& word) {
  if (word.value != std::round(word.value) || word.value < kOrder || word.value > kMostOrder) {
    refuse(word.place, fmt::format("L, the order of a NURBS, is {} to {}", kOrder, kMostOrder));
  }
  curve_.degree = static_cast<int>(word.value) - 1;
}

double Splines::weight_of(const Word& word) {
  if (word.value > 0 && word.value <= kMostWeight) return word.value;
  refuse(word.place, "P, the weight of a control point, is more than 0, to 1 000 000");
}

void Splines::add_point(Block& block, std::size_t place) {
  if (!block.has('X') || !block.has('Y') || !block.has('P'))
    refuse(place, "a control point of a NURBS has X, Y and its weight P");
  const double weight = weight_of(block.use('P'));
  if (const Word* order = block.find('L')) set_order(*order);
  if (curve_.points.size() == kMostPoints) refuse(place, fmt::format("a NURBS of more than {} points", kMostPoints));
  curve_.points.push_back(motions_.end_of(block, place));
  curve_.weights.push_back(weight);
}

void Splines::go_on(Block& block) {
  const auto& motion = block.g(GGroup::Motion);
  if (block.does_more_than_move() || (motion && motion->number < kNurbs) || (motion && motion->number > kNurbs + 1)) {
    refuse(0, "between G5.2 and G5.3 each block is a control point, X, Y and P, and nothing else");
  }
  if (block.has('Z')) refuse(block.use('Z').place, "a spline has no Z: it lies in the XY plane");
  if (motion && motion->number != kNurbs) return close_curve(motion->place);
  add_point(block, motion ? motion->place : 0);
}

void Splines::close_curve(std::size_t place) {
  const legacy::Nurbs curve = std::exchange(curve_, {});
  if (curve.points.size() <= static_cast<std::size_t>(curve.degree)) {
    refuse(place, fmt::format("a NURBS of order {} needs as many points, the start counted; it has {}",
                              curve.degree + 1, curve.points.size()));
  }
  mover_.nurbs(curve, place);
}

}  // namespace rmac::gcode
