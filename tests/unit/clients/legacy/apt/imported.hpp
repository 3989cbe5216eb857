#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/apt/import.hpp"
#include "unit/clients/legacy/imported.hpp"

namespace rmac::apt {

using legacy::end_of, legacy::Imported, legacy::Point, legacy::requests_in;
using nlohmann::json;

/// A program in mm that begins at 0,0,10 with a feed, for what a test is about.
inline std::string program_of(std::string_view lines) {
  return "UNITS/MM\nFEDRAT/600,MMPM\nRAPID\nGOTO/0,0,10\n" + std::string(lines) + "\nFINI\n";
}

inline Imported imported(const std::string& program, const Options& options = {}) {
  std::string text;
  const auto outcome = import_program(program, options, [&text](std::string_view part) { text += part; });
  return legacy::read_back(outcome, text, program, options.rapid_mm_min);
}

/// "LINE:COLUMN: message" of a program that is not taken.
inline std::string refusal_of(const std::string& program, const Options& options = {}) {
  return legacy::refusal_in(import_program(program, options, [](std::string_view) {}));
}

/// The moves of the program's lines, after the first rapid.
inline std::vector<json> moves_of(const std::string& lines, const Options& options = {}) {
  return legacy::moves_in(imported(program_of(lines), options));
}

/// Where the moves of the program's lines end, after the first rapid.
inline std::vector<std::vector<double>> ends_of(const std::string& lines, const Options& options = {}) {
  return legacy::ends_in(imported(program_of(lines), options));
}

}  // namespace rmac::apt
