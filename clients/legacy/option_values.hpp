#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/gcode/modes/modes.hpp"

// What stands behind options of the command line, as text: false or nothing where it is none of these.

namespace rmac {

/// 0,0,50: in mm.
[[nodiscard]] std::optional<legacy::Point> read_point(const std::string& text);
/// How a language names the work systems behind G59, up to which number; RS274/NGC unless said.
struct FurtherSystems {
  std::string_view prefix = "G59.";
  int most = 3;
};
/// G54=X,Y,Z, or one of the further.
[[nodiscard]] bool read_offset(const std::string& text, const FurtherSystems& further,
                               std::map<std::size_t, gcode::Known>& offsets);
/// 500=12.5.
[[nodiscard]] bool read_variable(const std::string& text, std::map<int, double>& variables);
/// M10.
[[nodiscard]] bool read_m(const std::string& text, std::set<int>& codes);
/// C,-A.
[[nodiscard]] std::vector<gcode::RotaryAxis> read_rotary(const std::string& text);
/// A=X,Y,Z of one of them, or X,Y,Z of all.
[[nodiscard]] bool read_rotary_centre(const std::string& text, std::vector<gcode::RotaryAxis>& axes);
/// 3=Clamp.
[[nodiscard]] bool read_name(const std::string& text, std::map<int, std::string>& names);
/// 3=10.
[[nodiscard]] bool read_diameter(const std::string& text, std::map<int, double>& diameters);

}  // namespace rmac
