#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>

#include "clients/legacy/gcode/modes/arc_geometry.hpp"
#include "clients/legacy/program/vectors.hpp"

namespace rmac::gcode {

/// Of each axis its value, or none where it is not known.
using Known = std::array<std::optional<double>, 3>;

/// Where the tool tip is, and what coordinates mean. A program's coordinates are those of the part (the frame of the
/// active work system, which `.rmac` moves in) less what G92 set. Where a work system is in the machine is known only
/// when the program, or who imports it, says so. All in mm. Where a placement or a turned table is in force, all of
/// this is so in coordinates that they lead to those of the part from: the placement first.
class Coordinates {
 public:
  [[nodiscard]] const Known& tip() const noexcept { return tip_; }
  [[nodiscard]] bool tip_is_known() const noexcept { return tip_[0] && tip_[1] && tip_[2]; }
  [[nodiscard]] Point known_tip() const { return {tip_[0].value(), tip_[1].value(), tip_[2].value()}; }
  void move_to(const Point& part) noexcept { tip_ = {part[0], part[1], part[2]}; }
  /// What a tool change leaves.
  void forget_tip() noexcept { tip_ = {}; }

  [[nodiscard]] std::size_t active() const noexcept { return active_; }
  /// Of a work system by its index: 0 is G54.
  [[nodiscard]] const Known& offset(std::size_t system) const;
  /// Where the active system is; none unless all of it is known.
  [[nodiscard]] std::optional<Point> part_origin() const;
  /// The tip stays where it is in the machine, so that it has other coordinates, or none that are known.
  void set_offset(std::size_t system, const Known& offset);
  void activate(std::size_t system);

  [[nodiscard]] double g92(std::size_t axis) const { return g92_.at(axis); }
  void set_g92(const Point& offset) noexcept { g92_ = saved_g92_ = offset; }
  void suspend_g92() noexcept { g92_ = {}; }
  void restore_g92() noexcept { g92_ = saved_g92_; }
  /// G52: the same of all work systems, beside G92.
  [[nodiscard]] const Point& local() const noexcept { return local_; }
  void set_local(const Point& offset) noexcept { local_ = offset; }

  /// Turned, tilted and mirrored coordinates; none: as they are. The tip stays where it is in the part.
  [[nodiscard]] const std::optional<legacy::Placement>& placement() const noexcept { return placement_; }
  void place(const std::optional<legacy::Placement>& placement);
  /// A table that has turned the part away from where its coordinates are those of the machine's axes; none: it stands
  /// at zero, or X, Y and Z are those of the part anyway.
  [[nodiscard]] const std::optional<legacy::Placement>& table() const noexcept { return table_; }
  /// The table turns: the tip stays where it is in the machine.
  void turn(const std::optional<legacy::Placement>& table) {
    table_ = table == legacy::Placement{} ? std::nullopt : table;
  }
  /// X, Y and Z mean other places from now on: the tip stays where it is on the part.
  void see_from(const std::optional<legacy::Placement>& table);

  /// All of them.
  [[nodiscard]] std::optional<legacy::Placement> whole() const;
  [[nodiscard]] Point placed(const Point& point) const {
    return table_ ? table_->placed(beside_table(point)) : beside_table(point);
  }
  /// Where coordinates of the part are.
  [[nodiscard]] Point unplaced(const Point& part) const {
    const auto all = whole();
    return all ? all->back().placed(part) : part;
  }
  /// Between them: in coordinates that do not turn with the table.
  [[nodiscard]] Point beside_table(const Point& point) const { return placement_ ? placement_->placed(point) : point; }

  /// Coordinates of the program.
  [[nodiscard]] double to_part(std::size_t axis, double program) const { return program + shift(axis); }
  [[nodiscard]] std::optional<double> program_tip(std::size_t axis) const;
  [[nodiscard]] std::optional<double> machine_tip(std::size_t axis) const;

 private:
  [[nodiscard]] double shift(std::size_t axis) const { return g92_.at(axis) + local_.at(axis); }
  void keep_in_machine(const Known& machine);

  Known tip_{};
  std::map<std::size_t, Known> offsets_;
  std::optional<legacy::Placement> placement_, table_;
  Point g92_{}, saved_g92_{}, local_{};
  std::size_t active_ = 0;
};

}  // namespace rmac::gcode
