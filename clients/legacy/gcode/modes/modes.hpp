#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/blocks/refusal.hpp"
#include "clients/legacy/gcode/flow/endless.hpp"
#include "clients/legacy/gcode/modes/arc_geometry.hpp"
#include "clients/legacy/gcode/modes/coordinates.hpp"
#include "clients/legacy/gcode/modes/rules.hpp"

namespace rmac::gcode {

/// What lengths and angles without a decimal point count in: mm, inches and degrees, or thousandths of mm and degrees
/// and ten-thousandths of inches.
enum class WholeNumbers { Refused, Units, Increments };

/// An axis of the machine that turns the tool about X (A), Y (B) or Z (C) of the part, counter-clockwise seen against
/// that where the angle grows, or the other way.
struct RotaryAxis {
  char letter = 'A';
  double sign = 1;
  std::optional<Point> centre_mm;  ///< of one that turns the table: a point on it, in the coordinates of the begin
};

/// Which way an axis of the table goes to an angle under G90: as the numbers have it, or by no more than half a turn.
enum class RotaryWay { Written, Shorter };

/// How programs say which way the tool points: not at all, by angles of the machine's axes, or by vectors.
enum class ToolCentrePoint { Off, Angles, Vectors };

/// What whoever imports a program says of it, because it does not say it itself.
struct Options {
  bool block_delete = false;           ///< the switch of the panel: blocks that begin with / are left out
  bool assume_g43 = false;             ///< the tool's length counts from M6 on, as if G43 stood there
  bool assume_end = false;             ///< the program ends where its file does, as if M2 stood there
  double rapid_mm_min = 3000;          ///< of G0: the appliance positions at the feed in force
  std::optional<double> unit_mm;       ///< of a program without G20 and G21
  std::optional<double> tolerance_mm;  ///< of G64 without P
  std::optional<Point> approach_mm;    ///< where the tip goes first, and after each tool change
  std::optional<Point> reference_mm, second_reference_mm;  ///< of G28 and G30, in the coordinates of the part
  std::map<int, std::string> outputs, inputs;              ///< names of the machine's, by the numbers of M62 to M66
  std::map<int, double> tool_diameters_mm;                 ///< of G41 and G42, by the numbers of the tools
  WholeNumbers whole_numbers = WholeNumbers::Refused;
  std::map<int, double> variables;  ///< what the machine has in common variables, by their numbers
  std::vector<RotaryAxis> rotary;   ///< what A, B and C turn, from the part to the tool
  std::optional<RotaryWay> rotary_way;
  std::optional<double> rotary_diameter_mm;  ///< that a table's angles count as ways on, in F
  std::set<int> passed_m;                    ///< M codes of the machine that mean nothing here
  legacy::Ids ids = legacy::Ids::Numbers;
  Bounds bounds;                         ///< of loops and subprograms
  std::map<std::size_t, Known> offsets;  ///< where the work systems are in the machine, by their index
};

/// Whether programmed Z is the tip's.
enum class ToolLength { Unsaid, On, Off };

/// What holds from one block to the next.
struct Modes {
  static constexpr int kNoMotion = 800;

  std::optional<double> unit_mm;
  bool unit_is_said = false;      ///< by the program, and not by an option alone
  int motion = kNoMotion;         ///< tenfold G code
  int interpolation = kNoMotion;  ///< the last of G0 to G3
  WholeNumbers whole_numbers = WholeNumbers::Refused;
  Plane plane;
  bool incremental = false, absolute_centres = false, retract_to_r = false;
  double feed_mm_min = 0, feed_degrees_min = 0;  ///< the latter: the number of F
  bool inverse_time = false;                     ///< G93: F is how many such moves a minute has
  double moves_per_min = 0;                      ///< of the block, where that holds; 0: it has none
  ToolLength length = ToolLength::Unsaid;
  ToolCentrePoint centre_point = ToolCentrePoint::Off;
  std::optional<int> diameter_register;  ///< the last D, where that is an offset

  /// That lengths are written in, mm. `place`: of a length.
  [[nodiscard]] double unit(std::size_t place) const {
    if (!unit_mm)
      refuse(place, "no G20 or G21 says whether this is inches or mm; write one in the first block, or give --unit");
    return *unit_mm;
  }
  /// Of a move that is so long, mm/min, or degrees where it only turns.
  [[nodiscard]] double feed_over(double way, std::size_t place) const {
    constexpr double kLeast = 0.1;  // as LinuxCNC has it
    if (!inverse_time) return feed_mm_min;
    if (moves_per_min == 0)
      refuse(place,
             "under G93 each move at feed has an F of its own, how many such moves a minute has; write F, or G94");
    return std::max(kLeast, way * moves_per_min);
  }
  [[nodiscard]] double mm(const Word& word) const {
    static_cast<void>(unit(word.place));
    return number(word, *unit_mm == 1 ? kIncrement : kIncrement / 10) * *unit_mm;
  }
  [[nodiscard]] double degrees(const Word& word) const { return number(word, kIncrement); }
  /// `unit`: that F counts in, mm.
  [[nodiscard]] double feed(const Word& word, double unit) const {
    constexpr double kFeedIncrement = 1e-2;  // of an inch; of mm it is one
    return (unit == 1 ? word.value : number(word, kFeedIncrement)) * unit;
  }
  /// `increment`: what the word counts in where it has no decimal point and the program goes by increments.
  [[nodiscard]] double number(const Word& word, double increment = kIncrement) const {
    if (!word.whole || word.value == 0 || whole_numbers == WholeNumbers::Units) return word.value;
    if (whole_numbers == WholeNumbers::Increments) return word.value * increment;
    refuse(word.place,
           "no decimal point: some controls count this in mm, inches or degrees, others in thousandths or less; write "
           "the point, or give --whole-numbers units or --whole-numbers increments");
  }

  static constexpr double kIncrement = 1e-3;
};

inline constexpr std::array<char, 3> kAxisLetters{'X', 'Y', 'Z'};
inline constexpr std::array<char, 3> kCentreLetters{'I', 'J', 'K'};

}  // namespace rmac::gcode
