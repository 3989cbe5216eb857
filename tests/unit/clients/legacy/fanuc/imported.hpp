#pragma once

#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/fanuc/import.hpp"
#include "unit/clients/legacy/imported.hpp"

namespace rmac::fanuc {

using legacy::Imported;

/// A program in mm that begins at X0 Y0 Z10 with a feed, for what a test is about in its lines from 5 on; `programs`
/// stand behind its end.
inline std::string program_of(std::string_view lines, std::string_view programs = {}) {
  return "%\nO1 (TEST)\nG21 G90 G17 G40 G80 F600.\nG0 X0 Y0 Z10.\n" + std::string(lines) + "\nM30\n" +
         std::string(programs) + "%\n";
}

inline std::string text_of(const std::string& program, const Options& options = {}) {
  std::string text;
  const auto outcome = import_program(program, options, [&text](std::string_view part) { text += part; });
  return outcome ? text : legacy::refusal_in(outcome);
}

inline Imported imported(const std::string& program, const Options& options = {}, Dialect dialect = Dialect::Fanuc) {
  std::string text;
  const auto outcome = import_program(
      program, options, [&text](std::string_view part) { text += part; }, dialect);
  return legacy::read_back(outcome, text, program, options.rapid_mm_min);
}

/// "LINE:COLUMN: message" of a program that is not taken.
inline std::string refusal_of(const std::string& program, const Options& options = {},
                              Dialect dialect = Dialect::Fanuc) {
  return legacy::refusal_in(import_program(
      program, options, [](std::string_view) {}, dialect));
}

/// Where the moves of the program's lines end, after the first rapid.
inline std::vector<std::vector<double>> ends_of(const std::string& lines, const Options& options = {},
                                                std::string_view programs = {}) {
  return legacy::ends_in(imported(program_of(lines, programs), options));
}

/// X of a G0 to this value.
inline double value_of(const std::string& value, const std::string& lines_before = {}) {
  const auto ends = ends_of(lines_before + "G0 Y1. X" + value);
  return ends.empty() ? NAN : ends.back().at(0);
}

/// X of the ends of the moves.
inline std::vector<double> xs_of(const std::string& lines, std::string_view programs = {}) {
  std::vector<double> xs;
  for (const auto& end : ends_of(lines, {}, programs)) xs.push_back(end.at(0));
  return xs;
}

}  // namespace rmac::fanuc
