#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/modes/coordinates.hpp"

namespace rmac::gcode {

struct Modes;

/// As programs write a work system, and what sets it.
struct SystemName {
  std::string name, setter;
};

/// Where languages mean different things by the same words.
struct Rules {
  /// The index of the work system that a code of the group System selects.
  std::size_t (*system_of)(Block& block, const Code& code) = nullptr;
  SystemName (*system_name)(std::size_t system) = nullptr;
  /// G10, G52, G92 and its like: what changes the meaning of coordinates.
  void (*set_coordinates)(Block& block, const Code& code, const Modes& modes, Coordinates& coordinates) = nullptr;

  bool arcs_have_turns = false;       ///< P of an arc
  bool needs_path_tolerance = false;  ///< G64 without P says less than is to be known
  /// D of G41 is the number of an offset, that stays; its first move ends beside the begin of the second one, before an
  /// inside corner too, and the first one behind G40 has a way in X or Y. Else D is a tool.
  bool radius_is_offset = false;
  /// X0, Y0 and Z0 of G53 are the first reference point, and those are told in the first frame of G54: in others they
  /// are elsewhere.
  bool reference_is_zero = false;
  bool motion_outlives_cycles = false;  ///< behind G80 the last of G0 to G3 is in force again
  bool stops_behind_motion = false;     ///< M5 and M9 act behind the motion of their block
  bool spindle_needs_speed = false;     ///< M3 and M4 before any S are refused
  bool unit_ends_feed = false;          ///< F does not outlive another unit, and beside it counts in the new one
  bool turns_as_written = false;        ///< a table goes to an angle as the numbers have it; else that is to be said
  bool degrees_are_lengths = false;     ///< F of a move that turns a table is of X, Y, Z and of its degrees together
  bool stops_switch_off = false;        ///< M0 ends spindle and coolant, and M1 coolant
  /// What the control tells of work systems behind the first six; 0: not known here.
  double further_in_force = 0;
  double whole_dwell_s = 1;  ///< of a P without a decimal point

  struct Cycles {
    std::string_view repeats = "L";  ///< letters
    bool may_wait = false;           ///< none at all is a number of repeats
    bool words_stay = false;         ///< R, Z and Q from one cycle to another, until G80
    bool dwell_is_free = false;      ///< each may have P, and none needs it
    bool cross_first = false;        ///< to the hole where the tool is, and then to R
    bool bore_to_r = false;          ///< G89 comes up at feed to R alone, as G85 does
    bool may_turn = false;           ///< a hole may have an angle of the table beside it, or nothing but that
    bool may_peck_less = false;      ///< I, J and K are of pecks that become less, which is refused
    bool levels_stay = false;  ///< R and Z that a block does not say are where they were, whatever mode is in force
  } cycles;
};

}  // namespace rmac::gcode
