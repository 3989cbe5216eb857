#include "clients/legacy/gcode/modes/coordinates.hpp"

namespace rmac::gcode {

namespace {

/// Puts `by` in the place of one of its placements. The tip stays where it is on the part.
void replace(Coordinates& coordinates, std::optional<legacy::Placement>& which,
             const std::optional<legacy::Placement>& by) {
  if (by == which) return;
  const std::optional<Point> part =
      coordinates.tip_is_known() ? std::optional(coordinates.placed(coordinates.known_tip())) : std::nullopt;
  which = by;
  if (part) {
    coordinates.move_to(coordinates.unplaced(*part));
  } else {
    coordinates.forget_tip();
  }
}

}  // namespace

const Known& Coordinates::offset(std::size_t system) const {
  static const Known kUnknown;
  const auto found = offsets_.find(system);
  return found == offsets_.end() ? kUnknown : found->second;
}

void Coordinates::place(const std::optional<legacy::Placement>& placement) {
  replace(*this, placement_, placement);
}

void Coordinates::see_from(const std::optional<legacy::Placement>& table) {
  replace(*this, table_, table);
}

std::optional<legacy::Placement> Coordinates::whole() const {
  if (!table_ || !placement_) return table_ ? table_ : placement_;
  return table_->after(*placement_);
}

std::optional<Point> Coordinates::part_origin() const {
  const Known& offset = this->offset(active_);
  if (!offset[0] || !offset[1] || !offset[2]) return std::nullopt;
  return Point{*offset[0], *offset[1], *offset[2]};
}

std::optional<double> Coordinates::machine_tip(std::size_t axis) const {
  const auto& offset = this->offset(active_).at(axis);
  const auto& tip = tip_.at(axis);
  return offset && tip ? std::optional(*tip + *offset) : std::nullopt;
}

std::optional<double> Coordinates::program_tip(std::size_t axis) const {
  const auto& tip = tip_.at(axis);
  return tip ? std::optional(*tip - shift(axis)) : std::nullopt;
}

void Coordinates::keep_in_machine(const Known& machine) {
  const Known& offset = this->offset(active_);
  for (std::size_t axis = 0; axis < tip_.size(); ++axis) {
    const bool known = machine.at(axis) && offset.at(axis);
    tip_.at(axis) = known ? std::optional(*machine.at(axis) - *offset.at(axis)) : std::nullopt;
  }
}

void Coordinates::set_offset(std::size_t system, const Known& offset) {
  if (system != active_) {
    offsets_[system] = offset;
    return;
  }
  const Known machine{machine_tip(0), machine_tip(1), machine_tip(2)};
  offsets_[system] = offset;
  keep_in_machine(machine);
}

void Coordinates::activate(std::size_t system) {
  if (system == active_) return;
  const Known machine{machine_tip(0), machine_tip(1), machine_tip(2)};
  active_ = system;
  keep_in_machine(machine);
}

}  // namespace rmac::gcode
