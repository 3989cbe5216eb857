#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "gateway/rmac/plots/plot_program.hpp"
#include "gateway/rmac/wire/connection.hpp"
#include "gateway/rmac/wire/failure.hpp"

// How `rmac tune` moves a joint.

namespace rmac::cli {

/// What moves.
struct Stroke {
  int joint = 0;
  double travel = 0;  ///< mm or deg from where the joint stands, signed; it comes back
};

/// Swings at several speeds, for what a rigid joint is made of.
[[nodiscard]] Result<> swing_at_speeds(Connection& connection, const Stroke& stroke, const std::string& fault);

/// Strokes that creep: some turns of the motor there and back at a steady speed, and short ones to and fro, one record
/// each, of which `begins` says after which time it is.
struct CreepRecords {
  TemporaryFile turning, reversing;
  std::array<double, 2> begins{};
};

/// Creeps with the joint of which `tune.py` found this in its swings.
[[nodiscard]] Result<> creep_strokes(Connection& connection, const Stroke& stroke, const nlohmann::json& found,
                                     CreepRecords& records, const std::string& fault);

/// Swept sines (SweptSineServoControlLaw) of one stroke.
struct Sweep {
  double effort = 0;   ///< amplitude, N or N·m
  double speed = 0;    ///< of the stroke, mm/s or deg/s
  double full_hz = 0;  ///< below it the amplitude is less in proportion
  double from_hz = 20;
  double to_hz = 0;
  double period_s = 0.5;
  int sweeps = 7;
};

/// What fits the joint of which `tune.py` found this in its swings; `effort` unless a twentieth of `MaxEffort`.
[[nodiscard]] Sweep sweep_for(const Stroke& stroke, const nlohmann::json& found, std::optional<double> effort);

/// Strokes there and back at a steady speed with swept sines on the joint's effort. Its law is put back, also where it
/// fails.
[[nodiscard]] Result<> sweep_strokes(Connection& connection, const Stroke& stroke, const nlohmann::json& found,
                                     const Sweep& sweep, const std::string& fault);

}  // namespace rmac::cli
