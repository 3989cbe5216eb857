#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "clients/legacy/apt/import.hpp"

namespace rmac::apt {

using legacy::Point;
using nlohmann::json;

/// A program in mm that begins at 0,0,10 with a feed, for what a test is about.
inline std::string program_of(std::string_view lines) {
  return "UNITS/MM\nFEDRAT/600,MMPM\nRAPID\nGOTO/0,0,10\n" + std::string(lines) + "\nFINI\n";
}

/// Requests of `.rmac` text, without those that only set the feed of rapids.
inline std::vector<json> requests_in(const std::string& text, double rapid_mm_min = 3000) {
  std::vector<json> requests;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    auto request = json::parse(text.substr(at, end - at));
    if (request["params"] != json({{"Feedrate", rapid_mm_min}})) requests.push_back(std::move(request));
    at = end + 1;
  }
  return requests;
}

struct Imported {
  std::vector<json> requests;
  std::vector<std::string> methods;  ///< without RMAC_CAM.
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
  result.requests = requests_in(text, options.rapid_mm_min);
  for (const json& request : result.requests) result.methods.push_back(request["method"].get<std::string>().substr(9));
  return result;
}

/// "LINE:COLUMN: message" of a program that is not taken.
inline std::string refusal_of(const std::string& program, const Options& options = {}) {
  const auto summary = import_program(program, options, [](std::string_view) {});
  if (summary) return "taken";
  return fmt::format("{}:{}: {}", summary.error().line, summary.error().column, summary.error().message);
}

/// The moves of the program's lines, after the first rapid.
inline std::vector<json> moves_of(const std::string& lines, const Options& options = {}) {
  std::vector<json> moves;
  for (const json& request : imported(program_of(lines), options).requests) {
    for (const auto* key : {"TargetFrame", "EndPoint"}) {
      if (request["params"].contains(key)) moves.push_back(request);
    }
  }
  if (!moves.empty()) moves.erase(moves.begin());
  return moves;
}

/// A move's end.
inline json end_of(const json& move) {
  const json& params = move["params"];
  return params.contains("EndPoint") ? params["EndPoint"] : params["TargetFrame"];
}

/// Where the moves of the program's lines end, after the first rapid.
inline std::vector<std::vector<double>> ends_of(const std::string& lines, const Options& options = {}) {
  std::vector<std::vector<double>> ends;
  for (const json& move : moves_of(lines, options)) ends.push_back(end_of(move)["p"].get<std::vector<double>>());
  return ends;
}

}  // namespace rmac::apt
