#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/rs274/import.hpp"

namespace rmac::rs274 {

/// A program in mm that begins at X0 Y0 Z10 with a feed, for what a test is about.
inline std::string program_of(std::string_view lines) {
  return "G21 G90 G17 F600\nG0 X0 Y0 Z10\n" + std::string(lines) + "\nM2\n";
}

struct Imported {
  std::vector<nlohmann::json> requests;  ///< without the feed of rapids
  std::vector<std::string> methods;      ///< without RMAC_CAM.
};

inline Imported imported(const std::string& program, const Options& options = {}) {
  std::string text;
  const auto summary = import_program(program, options, [&text](std::string_view part) { text += part; });
  Imported result;
  if (!summary) {
    ADD_FAILURE() << summary.error().line << ":" << summary.error().column << ": " << summary.error().message << "\n"
                  << program;
    return result;
  }
  std::size_t all = 0;
  for (std::size_t at = 0; at < text.size(); ++all) {
    const std::size_t end = text.find('\n', at);
    const auto request = nlohmann::json::parse(text.substr(at, end - at));
    if (request["params"] != nlohmann::json({{"Feedrate", options.rapid_mm_min}})) {
      result.requests.push_back(request);
      result.methods.push_back(request["method"].get<std::string>().substr(9));
    }
    at = end + 1;
  }
  EXPECT_EQ(summary->requests, all);
  return result;
}

/// "LINE:COLUMN: message" of a program that is not taken.
inline std::string refusal_of(const std::string& program, const Options& options = {}) {
  const auto summary = import_program(program, options, [](std::string_view) {});
  if (summary) return "taken";
  return std::to_string(summary.error().line) + ":" + std::to_string(summary.error().column) + ": " +
         summary.error().message;
}

/// Where the moves of the program's lines end, after the first rapid.
inline std::vector<std::vector<double>> ends_of(const std::string& lines, const Options& options = {}) {
  std::vector<std::vector<double>> ends;
  for (const auto& request : imported(program_of(lines), options).requests) {
    for (const auto* key : {"TargetFrame", "EndPoint"}) {
      if (request["params"].contains(key)) ends.push_back(request["params"][key]["p"].get<std::vector<double>>());
    }
  }
  if (!ends.empty()) ends.erase(ends.begin());
  return ends;
}

/// X of a G0 to this value.
inline double value_of(const std::string& value, const std::string& lines_before = {}) {
  const auto ends = ends_of(lines_before + "G0 Y1 X" + value);
  return ends.empty() ? NAN : ends.back().at(0);
}

}  // namespace rmac::rs274
