#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gateway/verification/checks/check.hpp"

namespace rmac::verifier {

/// What was found out about one module of a mechanism, in one role: a law is checked with each joint's gains.
struct ModuleReport {
  std::string role;  ///< "kinematics", "servo control law of joint X", …
  std::string module;
  std::string build_id;  ///< empty when it did not come so far
  std::vector<std::string> passed;
  std::vector<std::string> not_checked;  ///< each with why
  std::optional<CounterExample> refusal;
  double cpu_s = 0;
};

struct Report {
  std::string mechanism;
  std::string file;  ///< its device.json
  int samples = 0;
  std::uint64_t seed = 0;
  std::vector<ModuleReport> modules;

  [[nodiscard]] bool passed() const noexcept;
  /// The first module that is refused, in one line; empty when none is.
  [[nodiscard]] std::string refusal() const;
};

[[nodiscard]] nlohmann::json to_json(const Report& report);
/// The report that `to_json` was given; an exception of the library where it is something else.
[[nodiscard]] Report report_of(const nlohmann::json& json);
/// As a person reads it.
[[nodiscard]] std::string to_text(const Report& report);

[[nodiscard]] nlohmann::json to_json(const CounterExample& example);
[[nodiscard]] CounterExample example_of(const nlohmann::json& json);

}  // namespace rmac::verifier
