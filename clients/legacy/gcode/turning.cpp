#include "clients/legacy/gcode/turning.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "clients/legacy/gcode/modes/offsets.hpp"
#include "clients/legacy/gcode/modes/turns.hpp"

namespace rmac::gcode {

namespace {

using legacy::Placement;

/// What leaves a point where it is.
Placement about(Placement turn, const Point& point) {
  turn.shift = legacy::difference(point, turn.turned(point));
  return turn;
}

}  // namespace

void Turning::act(Block& block) {
  if (const auto& code = block.g(GGroup::Mirror)) mirror(block, *code);
  const auto& code = block.g(GGroup::Turn);
  if (!code) return;
  if (code->number == 680) return turn(block, *code);
  if (code->number == 682) return tilt(block, *code);
  end();
}

void Turning::mirror(Block& block, const Code& code) {
  constexpr int kMirrors = 511;
  if (turn_ || tilt_)
    refuse(code.place, "a mirror in turned or tilted coordinates; write it before G68, and end it behind G69");
  const bool all = code.number != kMirrors && !block.has_any("XYZ");
  if (!all && !block.has_any("XYZ")) refuse(code.place, "G51.1 needs X, Y or Z: where the mirror is");
  for (std::size_t axis = 0; axis < mirrors_.size(); ++axis) {
    const char letter = kAxisLetters.at(axis);
    if (!block.has(letter) && !all) continue;
    const auto before = mirrors_.at(axis);
    mirrors_.at(axis) = std::nullopt;
    if (!all) {
      const Word word = block.take(letter);
      if (code.number == kMirrors) mirrors_.at(axis) = coordinates_.to_part(axis, modes_.mm(word));
    }
    if (before != mirrors_.at(axis)) doubts_.about(axis);
  }
  place();
}

void Turning::turn(Block& block, const Code& code) {
  if (turn_) refuse(code.place, "G68 in turned coordinates; write G69 before it");
  if (modes_.incremental) refuse(code.place, "G68 under G91; write G90 before it");
  if (!block.has('R')) refuse(code.place, "G68 needs R, the angle");
  Turn turn{modes_.plane, {}, modes_.degrees(block.take('R'))};
  for (const std::size_t axis : {turn.plane.first, turn.plane.second}) {
    const char letter = kAxisLetters.at(axis);
    if (block.has(letter)) {
      turn.centre.at(axis) = coordinates_.to_part(axis, modes_.mm(block.take(letter)));
    } else {
      doubts_.require_none(code.place);
      turn.centre.at(axis) = known_or_refuse(coordinates_.tip().at(axis), {0, code.place});
    }
    doubts_.about(axis);
  }
  require_centre_in_mirrors(turn, code.place);
  if (turns_back(turn)) turn.degrees = -turn.degrees;
  turn_ = turn;
  place();
}

void Turning::require_centre_in_mirrors(const Turn& turn, std::size_t place) const {
  if (turns_back(turn) && turn.plane.normal != 2)
    refuse(place, "a mirror and a turn in G18 or G19 are not taken; have the CAM program write the part as it lies");
  for (const std::size_t axis : {turn.plane.first, turn.plane.second}) {
    const auto& mirror = mirrors_.at(axis);
    if (mirror && *mirror != turn.centre.at(axis))
      refuse(place,
             fmt::format("the centre of a turn beside its mirror is not taken; write the {} of G51.1 here, or have the "
                         "CAM program write the part as it lies",
                         kAxisLetters.at(axis)));
  }
}

/// By Euler's angles: about Z, about the new X, about the new Z.
void Turning::tilt(Block& block, const Code& code) {
  if (tilt_ || turn_ || coordinates_.placement())
    refuse(code.place, "G68.2 in turned, tilted or mirrored coordinates; write G69, or G50.1, before it");
  if (const Word* kind = block.find('P'); kind != nullptr && kind->value != 0)
    refuse(kind->place, "of G68.2 there are Euler's angles, P0; have the post write those");
  Point origin{}, angles{};
  for (std::size_t axis = 0; axis < origin.size(); ++axis) {
    if (block.has(kAxisLetters.at(axis))) origin.at(axis) = modes_.mm(block.take(kAxisLetters.at(axis)));
    if (block.has(kCentreLetters.at(axis))) angles.at(axis) = modes_.degrees(block.take(kCentreLetters.at(axis)));
  }
  const Plane about_z, about_x{1, 2, 0};
  Placement tilt = turn_about_normal(about_z, angles[0])
                       .after(turn_about_normal(about_x, angles[1]))
                       .after(turn_about_normal(about_z, angles[2]));
  const Point shifts{shift(0), shift(1), shift(2)};
  tilt.shift = legacy::difference(legacy::along(shifts, 1, origin), tilt.turned(shifts));
  tilt_ = tilt;
  place();
}

void Turning::end() {
  if (turn_ && !tilt_) {
    doubts_.about(turn_->plane.first);
    doubts_.about(turn_->plane.second);
  }
  turn_.reset();
  tilt_.reset();
  if (coordinates_.placement()) place();
}

void Turning::place() {
  Placement all;
  for (std::size_t axis = 0; axis < mirrors_.size(); ++axis) {
    if (!mirrors_.at(axis)) continue;
    image_of(all, axis).at(axis) = -1;
    all.shift.at(axis) = 2 * *mirrors_.at(axis);
  }
  if (turn_) all = about(turn_about_normal(turn_->plane, turn_->degrees), turn_->centre).after(all);
  if (tilt_) all = tilt_->after(all);
  coordinates_.place(all == Placement{} ? std::nullopt : std::optional(all));
}

void Turning::align(Block& block, std::size_t place) {
  if (!tilt_) refuse(place, "this turns the tool onto a tilted plane, and none is in force; write G68.2 before it");
  static_cast<void>(block.find('P'));  // which of two ways the machine's axes may stand: the appliance knows its own
  mover_.turn(tilt_->z, place);
}

}  // namespace rmac::gcode
