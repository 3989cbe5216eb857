#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "clients/legacy/program/outcome.hpp"

// What an importer made of a program, in whatever language that was.

namespace rmac::legacy {

/// Requests of `.rmac` text, without those that only set the feed of rapids.
inline std::vector<nlohmann::json> requests_in(const std::string& text, double rapid_mm_min = 3000) {
  std::vector<nlohmann::json> requests;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    auto request = nlohmann::json::parse(text.substr(at, end - at));
    if (request["params"] != nlohmann::json({{"Feedrate", rapid_mm_min}})) requests.push_back(std::move(request));
    at = end + 1;
  }
  return requests;
}

struct Imported {
  std::vector<nlohmann::json> requests;  ///< without the feed of rapids
  std::vector<std::string> methods;      ///< without RMAC_CAM.
};

/// `text` is what came of `program`, and `outcome` what was said of it.
template <typename Outcome>
Imported read_back(const Outcome& outcome, const std::string& text, const std::string& program, double rapid_mm_min) {
  Imported result;
  if (!outcome) {
    ADD_FAILURE() << outcome.error().line << ":" << outcome.error().column << ": " << outcome.error().message << "\n"
                  << program;
    return result;
  }
  result.requests = requests_in(text, rapid_mm_min);
  for (const auto& request : result.requests) result.methods.push_back(request["method"].get<std::string>().substr(9));
  EXPECT_EQ(outcome->requests, static_cast<std::size_t>(std::ranges::count(text, '\n')));
  return result;
}

/// "LINE:COLUMN: message" of a program that is not taken.
template <typename Outcome>
std::string refusal_in(const Outcome& outcome) {
  if (outcome) return "taken";
  return fmt::format("{}:{}: {}", outcome.error().line, outcome.error().column, outcome.error().message);
}

/// The moves, after the first rapid.
inline std::vector<nlohmann::json> moves_in(const Imported& imported) {
  std::vector<nlohmann::json> moves;
  for (const auto& request : imported.requests) {
    const auto& params = request["params"];
    if (params.contains("TargetFrame") || params.contains("EndPoint")) moves.push_back(request);
  }
  if (!moves.empty()) moves.erase(moves.begin());
  return moves;
}

/// A move's end.
inline nlohmann::json end_of(const nlohmann::json& move) {
  const auto& params = move["params"];
  return params.contains("EndPoint") ? params["EndPoint"] : params["TargetFrame"];
}

/// Where the moves end, after the first rapid.
inline std::vector<std::vector<double>> ends_in(const Imported& imported) {
  std::vector<std::vector<double>> ends;
  for (const auto& move : moves_in(imported)) ends.push_back(end_of(move)["p"].get<std::vector<double>>());
  return ends;
}

}  // namespace rmac::legacy
