#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "clients/legacy/gcode/mover.hpp"
#include "clients/legacy/gcode/switches.hpp"

namespace rmac::gcode {

/// The canned cycles that need no angle of the spindle, along the normal of the plane: G81, G82 (with a dwell), G83 and
/// G73 (pecking), G85, G86 and G89 (boring). What a block does not
/// say stays as the block before it had it, as long as the cycle is the same.
class Drilling {
 public:
  Drilling(const Rules& rules, const Modes& modes, Coordinates& coordinates, Mover& mover, Switches& switches,
           Writer& writer)
      : rules_(rules.cycles),
        whole_dwell_s_(rules.whole_dwell_s),
        modes_(modes),
        coordinates_(coordinates),
        mover_(mover),
        switches_(switches),
        writer_(writer) {}

  /// `code` and that of the motion before: tenfold.
  void drill(Block& block, int code, int before, std::size_t place);

 private:
  void read(Block& block, int code, std::size_t place);
  /// R and Z, where the block writes them, in coordinates of the part.
  void set_levels(Block& block);
  [[nodiscard]] double sticky(Block& block, char letter, std::optional<double>& value, std::size_t place);
  /// Where a word leads from `at`, in coordinates of the part.
  [[nodiscard]] double written(const Word& word, std::size_t axis, const Point& at) const;
  void go_round(const Block& block, Point& at, std::size_t place) const;
  void peck(const Point& above, double bottom, int code, std::size_t place);
  void hole(const Point& above, double bottom, double clear, int code, std::size_t place);

  /// What its levels were meant in.
  struct Coordinated {
    std::size_t system = 0, normal = 2;
    Known offset{};
    Point shift{};
    legacy::Placement level{};  ///< what of a placement moves the levels
    bool operator==(const Coordinated&) const = default;
  };
  [[nodiscard]] Coordinated coordinated() const;

  const Rules::Cycles& rules_;
  double whole_dwell_s_;
  const Modes& modes_;
  Coordinates& coordinates_;
  Mover& mover_;
  Switches& switches_;
  Writer& writer_;
  std::optional<double> retract_, depth_, dwell_s_, peck_;  ///< R, and Z or its like, as programmed, in mm
  double retract_level_ = 0, bottom_level_ = 0;             ///< of them, in coordinates of the part
  bool bottom_by_retract_ = false;                          ///< Z was written as a way from R
  Coordinated begun_in_;                                    ///< the first of a row of cycles
  double initial_ = 0;  ///< level at which the first of a row of cycles began: G98 goes back there
};

}  // namespace rmac::gcode
