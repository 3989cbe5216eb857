#include "clients/legacy/apt/moves/coordinates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rmac::apt {

namespace {

constexpr double kInch_mm = 25.4;
/// How far from unit length a direction may be written.
constexpr double kUnitLength = 1e-3;
/// What rounding leaves of an axis along Z, a micrometre at a hundred millimetres.
constexpr double kUpright = 1e-8;

}  // namespace

void Coordinates::set_unit(Arguments& arguments) {
  const std::string& word = arguments.word("MM or INCHES");
  if (word == "MM" || word == "MILLIMETERS") {
    unit_mm_ = 1;
  } else if (word == "INCHES" || word == "INCH") {
    unit_mm_ = kInch_mm;
  } else {
    refuse(arguments.last_place(), fmt::format("UNITS/{} is not taken; write MM or INCHES", word));
  }
}

void Coordinates::set_multax(Arguments& arguments) {
  // An axis that is not Z stays in force behind OFF: no program says that the tool is upright again.
  multax_ = !arguments.take("OFF");
  if (multax_) static_cast<void>(arguments.take("ON"));
}

void Coordinates::set_axis(Arguments& arguments) {
  take_axis(triple(arguments.numbers({3}, "i,j,k"), 0), arguments.place());
}

void Coordinates::take_axis(const Point& program, std::size_t place) {
  const double size = length(program);
  if (!(std::abs(size - 1) <= kUnitLength))
    refuse(place, fmt::format("a tool axis has the length 1, this one {:.6g}; correct i, j, k", size));
  axis_ = scaled(1 / size, program);
  if (std::abs(axis_[0]) < kUpright && std::abs(axis_[1]) < kUpright && axis_[2] > 0) axis_ = legacy::unit_axis(2);
}

void Coordinates::set_translation(Arguments& arguments) {
  const Point program = triple(arguments.numbers({3}, "x,y,z"), 0);
  arguments.end();
  translation_ = scaled(unit_mm(arguments.place()), program);
}

double Coordinates::unit_mm(std::size_t place) const {
  if (!unit_mm_)
    refuse(place,
           "no UNITS says whether this is inches or mm; write UNITS/MM or UNITS/INCHES before it, or give --unit");
  return *unit_mm_;
}

Point Coordinates::point(const Point& program, std::size_t place) const {
  return along(placement_.placed(scaled(unit_mm(place), program)), 1, translation_);
}

Point Coordinates::vector(const Point& program, std::size_t place) const {
  return placement_.turned(scaled(unit_mm(place), program));
}

Point Coordinates::direction(const Point& program, std::size_t place) const {
  const double size = length(program);
  if (!(size > 1e-6 && size < 1e6)) refuse(place, "these three numbers tell no direction");
  return placement_.turned(scaled(1 / size, program));
}

Pose Coordinates::pose(const std::vector<double>& values, std::size_t place) {
  if (values.size() == 6) take_axis(triple(values, 3), place);
  return {point(triple(values, 0), place), axis(place)};
}

Point Coordinates::axis(std::size_t place) const {
  constexpr double kRounding = 2e-6;  // of six digits behind the point; at a tool of 100 mm 0.2 µm
  const Point turned = placement_.turned(axis_);
  if (multax_) return turned;
  const Point z = legacy::unit_axis(2);
  if (length(along(turned, -1, z)) <= kRounding) return z;
  refuse(place, fmt::format("the tool axis {:.6g},{:.6g},{:.6g} is not Z, and no MULTAX/ON is in force; write it, or "
                            "give --multax",
                            turned[0], turned[1], turned[2]));
}

}  // namespace rmac::apt
