#pragma once

#include <cstddef>
#include <string_view>

namespace rmac::gcode {

/// The report's modal groups: of each a block has one code at most. `Once` is its group 0, which acts in its block
/// alone.
enum class GGroup {
  Once,
  Motion,
  Plane,
  Distance,
  ArcDistance,
  Feed,
  Units,
  Radius,
  Length,
  Return,
  System,
  Control,
  SpindleMode,
  Turn,   ///< G68, G68.2 and G69
  Mirror  ///< G51.1 and G50.1
};
inline constexpr std::size_t kGGroups = 15;

enum class MGroup { Stop, Tool, Spindle, Mist, Flood, CoolantOff, Override, Io };
inline constexpr std::size_t kMGroups = 8;

/// A G code by its tenfold: 921 is G92.1.
struct GCode {
  int tenfold = 0;
  GGroup group = GGroup::Once;
  std::string_view refusal;  ///< why it is not taken, and what to do; empty where it is
};

struct MCode {
  int number = 0;
  MGroup group = MGroup::Stop;
  std::string_view refusal;
};

/// G70 and G71, as Mach has them: taken where they say what holds anyway.
inline constexpr int kInchOfMach = 700, kMmOfMach = 710;

/// Of moves that end where a probe touches, and of what they find: only the machine knows it, when it gets there.
inline constexpr std::string_view kProbing =
    "where a probe touches is only known when the machine gets there; write a measuring plan, which sets the "
    "part frame and lengths of tools before the program runs (rmac measure PLAN.json --apply), and take this out";
inline constexpr std::string_view kOverridesStay = "overrides belong to the operator, and no program takes them away";

}  // namespace rmac::gcode
