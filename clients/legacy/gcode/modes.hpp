#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>

#include "clients/legacy/gcode/arc_geometry.hpp"
#include "clients/legacy/gcode/blocks/block.hpp"
#include "clients/legacy/gcode/blocks/refusal.hpp"
#include "clients/legacy/gcode/coordinates.hpp"
#include "clients/legacy/gcode/flow/endless.hpp"

namespace rmac::gcode {

/// What whoever imports a program says of it, because it does not say it itself.
struct Options {
  bool block_delete = false;           ///< the switch of the panel: blocks that begin with / are left out
  bool assume_g43 = false;             ///< the tool's length counts from M6 on, as if G43 stood there
  double rapid_mm_min = 3000;          ///< of G0: the appliance positions at the feed in force
  std::optional<double> unit_mm;       ///< of a program without G20 and G21
  std::optional<double> tolerance_mm;  ///< of G64 without P
  std::optional<Point> approach_mm;    ///< where the tip goes first, and after each tool change
  std::optional<Point> reference_mm, second_reference_mm;  ///< of G28 and G30, in the coordinates of the part
  std::map<int, std::string> outputs, inputs;              ///< names of the machine's, by the numbers of M62 to M66
  std::map<int, double> tool_diameters_mm;                 ///< of G41 and G42, by the numbers of the tools
  legacy::Ids ids = legacy::Ids::Numbers;
  Bounds bounds;                         ///< of loops and subprograms
  std::map<std::size_t, Known> offsets;  ///< where the work systems are in the machine, by their index
};

/// Where languages mean different things by the same codes.
struct Rules {};

/// Whether programmed Z is the tip's.
enum class ToolLength { Unsaid, On, Off };

/// What holds from one block to the next.
struct Modes {
  static constexpr int kNoMotion = 800;

  std::optional<double> unit_mm;
  int motion = kNoMotion;  ///< tenfold G code
  Plane plane;
  bool incremental = false, absolute_centres = false, retract_to_r = false;
  double feed_mm_min = 0;
  ToolLength length = ToolLength::Unsaid;

  [[nodiscard]] double mm(const Word& word) const {
    if (!unit_mm)
      refuse(word.place,
             "no G20 or G21 says whether this is inches or mm; write one in the first block, or give --unit");
    return word.value * *unit_mm;
  }
};

inline constexpr std::array<char, 3> kAxisLetters{'X', 'Y', 'Z'};
inline constexpr std::array<char, 3> kCentreLetters{'I', 'J', 'K'};

}  // namespace rmac::gcode
